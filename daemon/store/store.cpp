#include "daemon/store/store.hpp"

#include <chrono>
#include <system_error>

#include "daemon/store/assess.hpp"

namespace a351::daemon {

Store::Store(record::FileLayer& files, StoreOptions options, const HostClock& clock,
             ReadQueue& reads)
    : files_(files),
      options_(std::move(options)),
      lock_(files, options_.root),
      keeper_(files, options_.root / "journal", options_.keeper),
      replay_(record::begin_recovery(files, options_.root / "journal")),
      known_stream_(record::stream_end(replay_.segments)),
      profile_(wire::find_profile(options_.station.profile)),
      journal_(files, options_.root, clock, reads, chunks_, progress_, options_.retry_interval),
      archive_(files, options_.root / "archive", options_.station.codes, clock, chunks_, progress_,
               {.post = [this](record::JournalChunk chunk) { journal_.post(std::move(chunk)); },
                .session_began = [this](const record::JournalHeader& header) { describe(header); },
                .recovered =
                    [this](const record::RecoveryReport& report) {
                        options_.recovered(report);
                        keeper_.start();  // It renames what the replay reads.
                    }},
               options_.retry_interval, replay_) {}

Store::~Store() { stop(); }

void Store::start() {
    is_running_ = true;
    archive_.start();
    journal_.start();
}

bool Store::stop() {
    if (!is_running_) return true;
    is_running_ = false;
    archive_.hurry();
    journal_.drain();
    const bool is_archived = archive_.join();
    return journal_.finish() && is_archived;
}

std::optional<Instant> Store::latest() { return archive_.latest(); }

std::optional<Instant> Store::at(UtcTime utc) { return archive_.at(utc); }

void Store::commit(const record::Event& event) { journal_.commit(event, options_.commit_patience); }

void Store::describe(const record::JournalHeader& header) {
    record::StationDescription description = options_.station;
    // The first samples stand for instants before their header by the filter's delay.
    description.start = header.clock.realtime - description.group_delay;
    description.product_id = header.product_id;
    description.serial_number = header.serial_number;
    description.firmware = header.firmware;
    description.declared_rate_hz = header.declared_rate_hz;
    if (const auto trouble = describe_station(files_, options_.root, description)) {
        const std::lock_guard lock(metadata_mutex_);
        metadata_trouble_ = *trouble;
    }
}

void Store::fill(Status& status) {
    const Progress::Indices indices = progress_.indices();
    if (indices.session) status.session = indices.session->to_hex();
    status.received = indices.received;
    status.journaled = indices.journaled;
    status.archived = indices.archived;

    const ArchiveStatus archive = archive_.status();
    if (const auto last = archive_.latest()) status.last_sample = last->utc;
    status.timing_state = archive.timing_state;
    status.timing_uncertainty = archive.timing_uncertainty;
    status.counters = archive.counters;
    if (archive.last_sample && profile_ != nullptr) {
        const wire::BurstValues& values = archive.last_sample->values;
        for (std::size_t axis = 0; axis < values.axes.size(); ++axis) {
            status.acceleration.at(axis) = profile_->acceleration(values.axes.at(axis));
        }
        status.temperature = profile_->temperature(values.temperature);
    }

    if (archive.is_replaying) {
        complain(status, Status::Level::warning,
                 "archive: the last run's journal is being brought in");
    }
    const JournalStatus journal = journal_.status();
    status.more_counters["journal_bytes"] = journal.bytes_written;
    status.more_counters["journal_faults"] = journal.faults;
    status.more_counters["events_refused"] = journal.events_refused;
    status.more_counters["archive_faults"] = archive.faults;
    status.more_counters["archive_records"] = archive.records;
    status.more_counters["archive_records_waiting"] = archive.records_waiting;
    status.more_counters["archive_waits"] = journal.archive_waits;
    const JournalKeeper::Status keeper = keeper_.status();
    status.more_counters["journal_segments_compressed"] = keeper.compressed;
    status.more_counters["journal_segments_removed"] = keeper.removed;
    status.more_counters["journal_keeper_faults"] = keeper.faults;
    if (keeper.faults > 0)
        complain(status, Status::Level::warning, "journal, closed segments: " + keeper.trouble);
    if (journal.is_faulty) complain(status, Status::Level::fault, "journal: " + journal.trouble);
    if (archive.is_faulty) complain(status, Status::Level::fault, "archive: " + archive.trouble);

    if (archive.chunks_lost > 0) {
        complain(status, Status::Level::fault,
                 "archive: chunks that it could not take: " + std::to_string(archive.chunks_lost) +
                     "; the journal holds them");
    }
    {
        const std::lock_guard lock(metadata_mutex_);
        if (!metadata_trouble_.empty())
            complain(status, Status::Level::warning, "metadata: " + metadata_trouble_);
    }
    if (!archive.is_marking) {
        complain(
            status, Status::Level::warning,
            "archive: a sync failed or a chunk was lost, so nothing more is called archived; the "
            "journal holds it, and the next start brings it in");
    }

    std::error_code error;
    const auto space = std::filesystem::space(options_.root, error);
    if (!error) status.disk_free_bytes = space.available;
}

}  // namespace a351::daemon
