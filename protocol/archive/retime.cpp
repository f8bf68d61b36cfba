#include "protocol/archive/retime.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>

#include "protocol/archive/archive_writer.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/events/event_log.hpp"

namespace a351::archive {
namespace {

namespace fs = std::filesystem;

/// Where the chunks come from, and the profile to read them with, if not their own.
struct Recording {
    std::vector<fs::path> segments;
    const wire::DeviceProfile* profile;
};

/// The chunks of a recording, in order.
class Chunks {
public:
    explicit Chunks(const Recording& recording)
        : sequence_(recording.segments), profile_(recording.profile) {}

    [[nodiscard]] std::optional<journal::Chunk> next() {
        auto chunk = sequence_.next();
        if (profile_ == nullptr || !chunk) return chunk;
        if (auto* const header = std::get_if<journal::Header>(&*chunk))
            *header = recorded_with(*profile_, std::move(*header));
        return chunk;
    }
    [[nodiscard]] const std::vector<journal::Damage>& damage() const noexcept {
        return sequence_.damage();
    }

private:
    journal::Sequence sequence_;
    const wire::DeviceProfile* profile_;
};

struct Discard final : Sink {
    void record(const std::string&, const PackedRecord&, std::int64_t) override {}
};

/// Writes the archives of one data root; the codes of a station may change between sessions.
class Archives final : public Sink {
public:
    Archives(files::FileLayer& files, fs::path archive)
        : files_(files), archive_(std::move(archive)) {}

    void begin(const journal::StationCodes& codes) {
        if (writer_ && codes == codes_) return;
        finish();
        codes_ = codes;
        writer_ = std::make_unique<Writer>(files_, archive_, codes);
    }
    void record(const std::string& channel, const PackedRecord& packed,
                std::int64_t last_index) override {
        writer_->record(channel, packed, last_index);
    }
    void finish() {
        if (!writer_) return;
        static_cast<void>(writer_->sync());
        records_ += writer_->records_written();
        writer_.reset();
    }
    [[nodiscard]] std::uint64_t records() const noexcept { return records_; }

private:
    files::FileLayer& files_;
    fs::path archive_;
    journal::StationCodes codes_;
    std::unique_ptr<Writer> writer_;
    std::uint64_t records_ = 0;
};

/// Reads the journal for the first time.
/// @throws std::runtime_error  it has no frame of the sensor.
void gather(const Recording& recording, Retiming& retiming) {
    const auto& segments = recording.segments;
    Discard nothing;
    Archiver archiver(nothing, &retiming);
    Chunks chunks(recording);
    while (const auto chunk = chunks.next()) archiver.take(*chunk);
    if (archiver.counters().frames > 0) return;
    std::string reason;
    if (!chunks.damage().empty()) {
        const journal::Damage& damage = chunks.damage().front();
        reason =
            fmt::format("; {}: offset {}: {}", damage.file.string(), damage.offset, damage.reason);
    }
    throw std::runtime_error(
        fmt::format("{}: no frame of the sensor can be read from {} segments{}",
                    segments.front().parent_path().string(), segments.size(), reason));
}

std::vector<RetimedSegment> write(const Recording& recording, Retiming& retiming,
                                  Archives& archives, RetimeReport& report) {
    std::vector<RetimedSegment> segments;
    std::vector<std::int64_t> firsts;  // Indices of their first samples.
    retiming.begin_second_pass();
    Archiver archiver(archives, &retiming);
    std::optional<journal::StationCodes> codes;
    Chunks chunks(recording);
    while (const auto chunk = chunks.next()) {
        const auto* const header = std::get_if<journal::Header>(&*chunk);
        if (header && header->codes != codes) {
            archiver.close_records();  // under their own codes
            archives.begin(header->codes);
            codes = header->codes;
        }
        if (header) {
            const bool continues =
                !segments.empty() && segments.back().header.session == header->session;
            firsts.push_back(continues ? archiver.last_index().value_or(-1) + 1 : 0);
            segments.push_back({*header, {}});
        }
        archiver.take(*chunk);
    }
    report.damage = chunks.damage();
    archiver.close_records();
    archives.finish();
    report.records = archives.records();
    report.counters = archiver.counters();
    for (std::size_t k = 0; k < segments.size(); ++k) {
        const journal::Header& header = segments[k].header;
        segments[k].start = retiming.time_of(header.session, firsts[k], header.clock.realtime);
    }
    return segments;
}

void write_events(files::FileLayer& files, const fs::path& root, const fs::path& out,
                  const Retiming& retiming) {
    for (events::Event event : events::read_events(root / "events").events) {
        if (event.session && event.index) {
            if (const auto utc = retiming.time_of(*event.session, *event.index, event.utc))
                event.utc = *utc;
        }
        events::append_event(files, out / "events", event);
    }
}

}  // namespace

void Retiming::begin_run(const journal::Header& header, timing::SampleClockOptions options,
                         timing::SampleClock& clock) {
    if (!is_second_pass_) {
        const std::size_t sleeps = histories_[header.boot_id].sleeps();
        runs_.push_back({header.session, header.boot_id, timing::Hindsight(options, sleeps), {}});
        return;
    }
    if (next_run_ == runs_.size())
        throw InputError(
            "the journal grew while it was read; allowed: a journal to which no daemon writes");
    Run& run = runs_[next_run_++];
    const timing::UtcHistory& history = histories_[run.boot_id];
    if (history.is_empty()) return;
    clock.use(run.hindsight.times(history), history.is_synchronised());
    run.hindsight = timing::Hindsight(options, 0);  // no longer needed
    run.clock = clock;
}

void Retiming::observe_clock(const timing::ClockReading& reading) {
    if (is_second_pass_) return;
    Run& run = runs_.back();
    timing::UtcHistory& history = histories_[run.boot_id];
    const std::size_t sleeps = history.sleeps();
    history.observe(reading);
    if (history.sleeps() != sleeps) run.hindsight.host_slept(history.sleeps());
}

void Retiming::observe(std::int64_t index, RawTime arrival) {
    if (!is_second_pass_) runs_.back().hindsight.observe(index, arrival);
}

std::size_t Retiming::unsynchronised_runs() const {
    return static_cast<std::size_t>(std::ranges::count_if(
        runs_, [this](const Run& run) { return !histories_.at(run.boot_id).is_synchronised(); }));
}

std::optional<UtcTime> Retiming::time_of(const journal::SessionId& session, std::int64_t index,
                                         UtcTime near) const {
    std::optional<UtcTime> nearest;
    for (const Run& run : runs_) {
        if (run.session != session || !run.clock) continue;
        const auto time = run.clock->time_of(index);
        if (!time) continue;
        if (!nearest || std::chrono::abs(time->utc - near) < std::chrono::abs(*nearest - near))
            nearest = time->utc;
    }
    return nearest;
}

journal::Header recorded_with(const wire::DeviceProfile& profile, journal::Header header) {
    const wire::DeviceProfile* const own = wire::find_profile(header.profile);
    if (own == nullptr)
        throw InputError("journal: unknown device profile '" + header.profile + "'");
    const auto lacks = [&](const std::string& setting) {
        return InputError(fmt::format("profile {} has no {}, with which the journal was recorded",
                                      profile.name, setting));
    };
    const auto own_rate =
        std::ranges::find(own->output_rates_hz, header.output_rate_hz, &wire::Coded::value);
    const wire::FilterSpec* const own_filter = own->filter_named(header.filter);
    header.profile = profile.name;
    if (own_rate == own->output_rates_hz.end() || own_filter == nullptr) return header;
    const auto rate =
        std::ranges::find(profile.output_rates_hz, own_rate->code, &wire::Coded::code);
    if (rate == profile.output_rates_hz.end())
        throw lacks(fmt::format("output rate with code {}", own_rate->code));
    const wire::FilterSpec* const filter = profile.filter_coded(own_filter->code);
    if (filter == nullptr) throw lacks(fmt::format("filter with code {}", own_filter->code));
    if (rate->value != header.output_rate_hz) header.declared_rate_hz.reset();
    header.output_rate_hz = rate->value;
    header.filter = filter->name;
    return header;
}

void copy_metadata(const fs::path& from, const fs::path& to) {
    if (fs::exists(from / "metadata"))
        fs::copy(from / "metadata", to / "metadata", fs::copy_options::recursive);
}

RetimeReport retime(files::FileLayer& files, const fs::path& root, const fs::path& out_as_given,
                    const wire::DeviceProfile* profile, const MetadataWriter& metadata) {
    const fs::path out = out_as_given.has_filename() ? out_as_given : out_as_given.parent_path();
    const Recording recording{journal::segment_files(root / "journal"), profile};
    if (recording.segments.empty())
        throw InputError(root.string() + ": no journal; allowed: the data root of a daemon");
    if (fs::exists(out))
        throw InputError("--out " + out.string() + ": already exists; allowed: a new directory");
    fs::path partial = out;
    partial += ".partial";
    if (fs::exists(partial)) {
        throw InputError(fmt::format("--out {}: {} was left by an interrupted run; remove it first",
                                     out.string(), partial.string()));
    }
    RetimeReport report;
    report.segments = recording.segments.size();
    try {
        files.create_directories(partial);
        Retiming retiming;
        gather(recording, retiming);
        Archives archives(files, partial / "archive");
        const auto segments = write(recording, retiming, archives, report);
        report.unsynchronised_runs = retiming.unsynchronised_runs();
        write_events(files, root, partial, retiming);
        metadata(root, partial, segments);
        files.rename(partial, out);
        files.sync_directory(fs::absolute(out).parent_path());
    } catch (...) {
        std::error_code ignored;
        fs::remove_all(partial, ignored);
        throw;
    }
    return report;
}

}  // namespace a351::archive
