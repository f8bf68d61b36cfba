#include "corrector/archive_series/export.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

#include "corrector/archive_series/epoch.hpp"
#include "corrector/archive_series/samples.hpp"
#include "corrector/archive_series/tilt.hpp"
#include "corrector/archive_series/utc_grid.hpp"
#include "protocol/archive/miniseed.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/units.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::archive_series {
namespace {

using std::chrono::days;

constexpr const char* kProductLocation = "10";
constexpr const char* kTiltUnit = "urad";

using Write = std::function<void(std::string_view)>;

[[noreturn]] void refuse_unit(const ExportOptions& options, std::string_view trouble,
                              std::string_view allowed = "counts") {
    throw InputError(fmt::format("--unit = {}: {}; allowed: {}", options.unit, trouble, allowed));
}

/// Returns the value of one count in the unit.
/// @throws InputError  the channel has another kind of unit.
double scale_of(const ExportOptions& options, const station::Metadata& metadata) {
    if (tilt_axis(options.channel)) {
        if (options.unit != kTiltUnit)
            refuse_unit(options, options.channel + " is an angle", kTiltUnit);
        return 1.0;
    }
    if (options.unit == "counts") return 1.0;
    if (options.unit == kTiltUnit) refuse_unit(options, options.channel + " is not a tilt");
    const auto channel =
        std::ranges::find(metadata.channels, options.channel, &station::ChannelScale::code);
    if (channel == metadata.channels.end() || channel->unit != "m/s**2")
        refuse_unit(options, options.channel + " is not a channel of acceleration");
    const double mgal = kMilliGalPerMps2 * channel->gain;
    constexpr double kMgPerStandardGravity = 1000.0;
    return options.unit == "mgal" ? mgal
                                  : mgal / kMilliGalPerStandardGravity * kMgPerStandardGravity;
}

/// Writes runs in order.
struct GridWriter {
    std::function<void(const GridRun&)> put;  ///< Writes values that follow the last ones.
    std::function<void()> end_run;
};

GridWriter csv_writer(const Write& write, const ExportOptions& options,
                      const station::Metadata& metadata) {
    const double scale = scale_of(options, metadata);
    write("time_utc," + options.unit + "\n");
    const auto put = [&write, rate_hz = options.rate_hz, scale](const GridRun& run) {
        std::string rows;
        for (std::size_t i = 0; i < run.values.size(); ++i) {
            const UtcTime time = grid_time(run.first + static_cast<std::int64_t>(i), rate_hz);
            rows += to_rfc3339(time, 9) + ',' + text::shortest(scale * run.values[i]) + '\n';
        }
        write(rows);
    };
    return {put, [&write] { write("\n"); }};
}

/// Values that are not in a record yet, and the header of the next one.
struct Unpacked {
    archive::RecordHeader header;
    int rate_hz;
    std::vector<std::int32_t> counts = {};
    std::int64_t first = 0;  ///< Number of the first one on the grid.

    void pack(const Write& write) {
        header.start = grid_time(first, rate_hz);
        const archive::PackedRecord packed = archive::pack_record(header, counts);
        write({reinterpret_cast<const char*>(packed.bytes.data()), packed.bytes.size()});
        const auto count = static_cast<std::ptrdiff_t>(packed.sample_count);
        counts.erase(counts.begin(), counts.begin() + count);
        first += count;
        header.sequence = header.sequence % archive::kLargestSequence + 1;
    }
};

GridWriter miniseed_writer(const Write& write, const ExportOptions& options,
                           const station::Metadata& metadata) {
    if (tilt_axis(options.channel))
        throw InputError(
            fmt::format("--format = mseed: {} has no counts; allowed: csv", options.channel));
    if (options.unit != "counts") refuse_unit(options, "records of miniSEED hold whole counts");
    archive::RecordHeader header;
    header.network = metadata.codes.network;
    header.station = metadata.codes.station;
    header.location = kProductLocation;
    header.channel = options.channel;
    header.nominal_rate = Hertz(options.rate_hz);
    const auto left = std::make_shared<Unpacked>(Unpacked{header, options.rate_hz});
    const auto put = [&write, left](const GridRun& run) {
        if (left->counts.empty()) left->first = run.first;
        for (const double value : run.values) {
            left->counts.push_back(static_cast<std::int32_t>(
                std::llround(std::clamp(value, -2147483648.0, 2147483647.0))));
            if (left->counts.size() == archive::kMostSamplesPerRecord) left->pack(write);
        }
    };
    return {put, [&write, left] {
                while (!left->counts.empty()) left->pack(write);
            }};
}

/// The formats: another one is a line here and its writer.
constexpr struct Format {
    std::string_view name;
    GridWriter (*writer)(const Write&, const ExportOptions&, const station::Metadata&);
} kFormats[]{{"csv", csv_writer}, {"mseed", miniseed_writer}};

/// Adds damage that is not yet in the report.  The same record may be read for two days, because
/// each day is read with a margin.
void note(ExportReport& report, const std::vector<archive::Damage>& damage) {
    for (const archive::Damage& one : damage) {
        const auto is_known = [&](const archive::Damage& known) {
            return known.file == one.file && known.offset == one.offset;
        };
        if (std::ranges::none_of(report.damage, is_known)) report.damage.push_back(one);
    }
}

/// Reads channels on the grid.
class GridReader {
public:
    GridReader(const ExportOptions& options, const station::Metadata& metadata,
               ExportReport& report)
        : options_(options), metadata_(metadata), report_(report) {}

    /// Returns the values of a channel within [begin, end), in the order of the archive.
    [[nodiscard]] std::vector<GridRun> read(const std::string& channel, UtcTime begin,
                                            UtcTime end) {
        // The kernel needs 32 zero crossings on either side: 32 s at 1 Hz.
        const std::chrono::seconds margin(33 / options_.rate_hz + 1);
        const auto scale =
            std::ranges::find(metadata_.channels, channel, &station::ChannelScale::code);
        const auto metadata_hz = scale == metadata_.channels.end() ? std::nullopt : scale->rate_hz;
        const archive::ChannelData data =
            archive::read_channel(options_.root / "archive", metadata_.codes, channel,
                                  begin - margin, end + margin, metadata_hz);
        if (data.rate_conflict && std::ranges::none_of(conflicts_, [&](const auto& known) {
                return known.rate_conflict->channel == channel;
            }))
            conflicts_.emplace_back().rate_conflict = data.rate_conflict;
        std::vector<GridRun> runs;
        for (const archive::Segment& segment : data.segments) {
            if (segment.rate_hz != source_rate_hz_) {
                source_rate_hz_ = segment.rate_hz;
                if (options_.rate_hz > 1.01 * source_rate_hz_)
                    throw InputError(fmt::format("--rate = {}; allowed: up to the {} Hz of {}",
                                                 options_.rate_hz, text::shortest(source_rate_hz_),
                                                 channel));
                grid_.emplace(source_rate_hz_, options_.rate_hz);
            }
            runs.push_back(grid_->resample(segment, begin, end));
        }
        note(report_, data.damage);
        return runs;
    }

    /// Returns the remark on a rate that contradicts the metadata; empty if none does.
    [[nodiscard]] text::Message rate() const { return rate_remark(conflicts_); }

private:
    const ExportOptions& options_;
    const station::Metadata& metadata_;
    ExportReport& report_;
    std::vector<archive::ChannelData> conflicts_;  ///< One of each channel, without samples.
    std::optional<UtcGrid> grid_;
    double source_rate_hz_ = 0.0;
};

/// Returns the tilt of an axis, urad, at the instants at which x, y and z have values.
std::vector<GridRun> tilt_runs(const std::vector<std::vector<GridRun>>& axes, const Epoch& epoch,
                               std::size_t axis) {
    std::vector<GridRun> tilts;
    std::array<std::size_t, 3> place{};
    const auto is_end = [&](std::size_t i) { return place.at(i) == axes[i].size(); };
    while (!is_end(0) && !is_end(1) && !is_end(2)) {
        std::array<const GridRun*, 3> runs{};
        GridRun tilt{std::numeric_limits<std::int64_t>::min(), {}};
        std::int64_t end = std::numeric_limits<std::int64_t>::max();
        std::size_t ends_first = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const GridRun& run = axes[i][place.at(i)];
            runs.at(i) = &run;
            tilt.first = std::max(tilt.first, run.first);
            if (const std::int64_t own = run.first + std::ssize(run.values); own < end) {
                end = own;
                ends_first = i;
            }
        }
        for (std::int64_t k = tilt.first; k < end; ++k) {
            std::array<double, 3> values{};
            for (std::size_t i = 0; i < 3; ++i)
                values.at(i) =
                    epoch.channels[i].offset +
                    epoch.channels[i].gain *
                        runs.at(i)->values[static_cast<std::size_t>(k - runs.at(i)->first)];
            tilt.values.push_back(tilt_urad(values, axis));
        }
        if (!tilt.values.empty()) tilts.push_back(std::move(tilt));
        ++place.at(ends_first);
    }
    return tilts;
}

}  // namespace

std::vector<std::string> export_formats() {
    std::vector<std::string> names;
    for (const Format& format : kFormats) names.emplace_back(format.name);
    return names;
}

ExportReport export_channel(const ExportOptions& options, const Write& write) {
    const std::filesystem::path file = options.root / "metadata" / "station.xml";
    const auto metadata = station::read_station_xml(file, options.from);
    const Format& format = *std::ranges::find(kFormats, options.format, &Format::name);
    const GridWriter writer = format.writer(write, options, metadata);
    ExportReport report;
    std::int64_t next = 0;  // number on the grid that would continue the run
    const auto take = [&](const GridRun& run) {
        if (run.values.empty()) return;
        if (run.first != next || report.runs == 0) {
            if (report.runs > 0) writer.end_run();
            if (run.first < next && !report.twice)
                report.twice = {grid_time(run.first, options.rate_hz),
                                grid_time(next, options.rate_hz)};
            ++report.runs;
        }
        writer.put(run);
        const auto count = static_cast<std::int64_t>(run.values.size());
        next = run.first + count;
        report.values += count;
    };
    const std::optional<std::size_t> tilted = tilt_axis(options.channel);
    std::optional<Epoch> epoch;
    std::vector<std::string> channels{options.channel};
    if (tilted) {
        epoch = epoch_of(options.from, metadata, file);
        channels.clear();
        for (std::size_t k = 0; k <= kVertical; ++k) channels.push_back(epoch->channels[k].code);
    }
    GridReader reader(options, metadata, report);
    for (UtcTime begin = options.from; begin < options.to;) {
        const UtcTime end =
            std::min<UtcTime>(options.to, std::chrono::floor<days>(begin) + days(1));
        std::vector<std::vector<GridRun>> runs;
        for (const std::string& channel : channels)
            runs.push_back(reader.read(channel, begin, end));
        if (tilted) runs = {tilt_runs(runs, *epoch, *tilted)};
        if (tilted && report.values == 0 && !runs.front().empty())
            require_horizontal(runs.front().front().values, *tilted, "--channel");
        for (const GridRun& run : runs.front()) take(run);
        begin = end;
    }
    if (tilted && report.twice)
        throw InputError(fmt::format(
            "{}: instants from {} on occur twice, because the host's clock was set back; allowed: "
            "each instant once; correct the times with a351-correct retime",
            options.root.string(), to_rfc3339(report.twice->front(), 3)));
    for (const auto& one : absent_files(options.root, options.from, options.to))
        if (std::ranges::count(channels, one.channel) > 0)
            report.remarks.push_back(to_message(one));
    if (text::Message rate = reader.rate(); !rate.empty())
        report.remarks.push_back(std::move(rate));
    if (report.values == 0) {
        throw InputError(
            fmt::format("{}: no samples of {} from {} to {}{}", options.root.string(),
                        options.channel, to_rfc3339(options.from), to_rfc3339(options.to),
                        report.remarks.empty() ? "" : ": " + report.remarks.front().english()));
    }
    writer.end_run();
    return report;
}

}  // namespace a351::corrector::archive_series
