#include "daemon/store/store.hpp"

#include <chrono>
#include <cmath>
#include <utility>

namespace a351::daemon::store {
namespace {

/// Returns the work for each hour of a span; std::nullopt if the span is too short for it.
std::optional<files::DiskWork> hourly(const files::DiskWork& work, Nanoseconds span) {
    if (span < std::chrono::minutes(1)) return std::nullopt;
    const double spans =
        Nanoseconds(std::chrono::hours(1)) / std::chrono::duration<double, std::nano>(span);
    const auto in_an_hour = [spans](std::uint64_t count) {
        return static_cast<std::uint64_t>(std::llround(spans * static_cast<double>(count)));
    };
    return files::DiskWork{in_an_hour(work.bytes), in_an_hour(work.syncs)};
}

}  // namespace

Store::Store(files::FileLayer& files, Options options, const source::HostClock& clock,
             source::ReadQueue& reads)
    : files_(files),
      options_(std::move(options)),
      began_(options_.time.now()),
      lock_(files, options_.root),
      keeper_(files, options_.root / "journal", options_.keeper),
      reserve_(files, options_.root / "state" / "reserve", options_.reserve_bytes),
      plan_(reserve_.use_for(
          [this] { return archive::begin_recovery(files_, options_.root / "journal"); })),
      known_stream_(plan_.replays.empty() ? std::nullopt
                                          : journal::stream_end(plan_.replays.back().segments)),
      profile_(wire::find_profile(options_.station.profile)),
      chunks_(options_.queue_bytes),
      journal_(files, options_.root, reads.capacity(), progress_, reserve_, options_.time),
      chunk_maker_(clock, reads, journal_, chunks_, options_.time),
      archive_(files, options_, clock, chunks_, progress_, reserve_, journal_, keeper_, plan_) {}

void Store::start() {
    is_running_ = true;
    keeper_.keep_names(true);  // The replay reads the segments that begin_recovery() found.
    keeper_.start();           // A full disk may delay the replay until old segments are removed.
    archive_.start();
    journal_.start();
    chunk_maker_.start();
}

void Store::step() {
    is_running_ = true;
    chunk_maker_.step();
    journal_.step();
    archive_.step();
}

bool Store::stop() {
    if (!is_running_) return true;
    is_running_ = false;
    archive_.skip_waits();
    chunk_maker_.drain();
    journal_.drain();
    const bool is_archived = archive_.join();
    return journal_.finish() && is_archived;
}

bool Store::is_alive() {
    const std::uint64_t rounds = chunk_maker_.status().rounds;
    const JournalStatus journal = journal_.status();
    const bool makes_chunks = std::exchange(rounds_, rounds) != rounds;
    const bool writes = std::exchange(journal_rounds_, journal.rounds) != journal.rounds;
    return makes_chunks && (writes || journal.present_sync.count() > 0);
}

void Store::fill(status::Status& status) {
    const Progress::Indices indices = progress_.indices();
    if (indices.session) status.session = indices.session->to_hex();
    status.received = indices.received;
    status.journaled = indices.journaled;
    status.archived = indices.archived;

    const ArchiveStatus archive = archive_.status();
    if (const auto last = archive_.latest()) status.last_sample = last->utc;
    status.timing_state = archive.timing_state;
    status.timing_uncertainty = archive.timing_uncertainty;
    status.host_uncertainty = archive.host_uncertainty;
    status.is_host_synchronised = archive.is_host_synchronised;
    status.measured_rate = archive.measured_rate;
    status.wrong_rate = archive.wrong_rate;
    status.clock_step = archive.clock_step;
    status.unit_change = archive.unit_change;
    status.started_again = archive.started_again;
    status.counters = archive.counters;
    if (archive.last_sample && profile_ != nullptr) {
        const wire::BurstValues& values = archive.last_sample->values;
        for (std::size_t axis = 0; axis < values.axes.size(); ++axis)
            status.acceleration.at(axis) = profile_->acceleration(values.axes.at(axis));
        status.temperature = profile_->temperature(values.temperature);
    }

    const JournalStatus journal = journal_.status();
    const JournalKeeper::Status keeper = keeper_.status();
    const SpaceReserve::Status reserve = reserve_.status();
    status.more_counters.insert({{"archive_conflicts", archive.conflicts},
                                 {"journal_bytes", journal.bytes_written},
                                 {"journal_faults", journal.faults},
                                 {"events_refused", journal.events_refused},
                                 {"reads_dropped", journal.reads_dropped},
                                 {"archive_faults", archive.faults},
                                 {"archive_chunks_lost", archive.chunks_lost},
                                 {"archive_records", archive.records},
                                 {"archive_records_waiting", archive.records_waiting},
                                 {"archive_records_dropped", archive.records_dropped},
                                 {"archive_waits", chunk_maker_.status().archive_waits},
                                 {"journal_segments_compressed", keeper.compressed},
                                 {"journal_segments_removed", keeper.removed},
                                 {"journal_keeper_faults", keeper.faults},
                                 {"reserve_given_up", reserve.times_given_up}});
    status.longest_sync = journal.longest_sync;
    status.disk_work = files_.work();
    status.hourly_disk_work = hourly(status.disk_work, options_.time.now() - began_);
    status.disk_free_bytes = files_.free_bytes(options_.root);
    status.disk_reserve = to_text(reserve.state);
    status.disk_reserve_trouble = reserve.trouble;

    report(journal, archive, keeper.trouble, reserve.is_space_short, status);
    if (!lock_.is_in_place())
        status.fail(text::message(
            "storage.root leads to another folder or to none: put it back, or stop a351d"));
}

}  // namespace a351::daemon::store
