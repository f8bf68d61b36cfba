#include "corrector/archive_series/export.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "corrector/archive_series/samples.hpp"
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

using Write = std::function<void(std::string_view)>;

[[noreturn]] void refuse_unit(const ExportOptions& options, std::string_view trouble) {
    throw InputError(fmt::format("--unit = {}: {}; allowed: counts", options.unit, trouble));
}

/// Returns the value of one count in the unit.
/// @throws InputError  the channel has another kind of unit.
double scale_of(const ExportOptions& options, const station::Metadata& metadata) {
    if (options.unit == "counts") return 1.0;
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

}  // namespace

std::vector<std::string> export_formats() {
    std::vector<std::string> names;
    for (const Format& format : kFormats) names.emplace_back(format.name);
    return names;
}

ExportReport export_channel(const ExportOptions& options, const Write& write) {
    const auto metadata =
        station::read_station_xml(options.root / "metadata" / "station.xml", options.from);
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
    const auto scale =
        std::ranges::find(metadata.channels, options.channel, &station::ChannelScale::code);
    const auto metadata_hz = scale == metadata.channels.end() ? std::nullopt : scale->rate_hz;
    text::Message rate;
    std::optional<UtcGrid> grid;
    double source_rate_hz = 0.0;
    for (UtcTime begin = options.from; begin < options.to;) {
        const UtcTime end =
            std::min<UtcTime>(options.to, std::chrono::floor<days>(begin) + days(1));
        // The kernel needs 32 zero crossings on either side: 32 s at 1 Hz.
        const std::chrono::seconds margin(33 / options.rate_hz + 1);
        const archive::ChannelData data =
            archive::read_channel(options.root / "archive", metadata.codes, options.channel,
                                  begin - margin, end + margin, metadata_hz);
        if (rate.empty()) rate = rate_remark({&data, 1});
        for (const archive::Segment& segment : data.segments) {
            if (segment.rate_hz != source_rate_hz) {
                source_rate_hz = segment.rate_hz;
                if (options.rate_hz > 1.01 * source_rate_hz) {
                    throw InputError(fmt::format("--rate = {}; allowed: up to the {} Hz of {}",
                                                 options.rate_hz, text::shortest(source_rate_hz),
                                                 options.channel));
                }
                grid.emplace(source_rate_hz, options.rate_hz);
            }
            take(grid->resample(segment, begin, end));
        }
        note(report, data.damage);
        begin = end;
    }
    for (const auto& one : absent_files(options.root, options.from, options.to))
        if (one.channel == options.channel) report.remarks.push_back(to_message(one));
    if (!rate.empty()) report.remarks.push_back(std::move(rate));
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
