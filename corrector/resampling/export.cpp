#include "corrector/resampling/export.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "corrector/resampling/utc_grid.hpp"
#include "protocol/archive/miniseed.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/units.hpp"
#include "protocol/station/station_xml.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::resampling {
namespace {

using std::chrono::days;

constexpr const char* kProductLocation = "10";

/// Writes runs in order; runs without a gap between them become one.
class GridWriter {
public:
    using Write = std::function<void(std::string_view)>;

    GridWriter(const Write& write, int rate_hz) : write_(write), rate_hz_(rate_hz) {}
    GridWriter(const GridWriter&) = delete;
    GridWriter& operator=(const GridWriter&) = delete;
    virtual ~GridWriter() = default;

    void take(const GridRun& run, ExportReport& report) {
        if (run.values.empty()) return;
        if (run.first != next_ || report.values == 0) {
            if (report.values > 0) end_run();
            ++report.runs;
        }
        put(run);
        next_ = run.first + static_cast<std::int64_t>(run.values.size());
        report.values += static_cast<std::int64_t>(run.values.size());
    }
    virtual void end_run() = 0;

protected:
    virtual void put(const GridRun& run) = 0;
    void write(std::string_view bytes) const { write_(bytes); }
    [[nodiscard]] UtcTime time_of(std::int64_t k) const { return grid_time(k, rate_hz_); }

private:
    const Write& write_;
    int rate_hz_;
    std::int64_t next_ = 0;
};

class CsvGrid : public GridWriter {
public:
    /// @param scale  value of one count in the unit.
    CsvGrid(const Write& write, int rate_hz, const std::string& unit, double scale)
        : GridWriter(write, rate_hz), scale_(scale) {
        this->write("time_utc," + unit + "\n");
    }
    void end_run() override { write("\n"); }

private:
    void put(const GridRun& run) override {
        std::string rows;
        for (std::size_t i = 0; i < run.values.size(); ++i) {
            rows += to_rfc3339(time_of(run.first + static_cast<std::int64_t>(i)), 9) + ',' +
                    text::shortest(scale_ * run.values[i]) + '\n';
        }
        write(rows);
    }

    double scale_;
};

class MiniseedGrid : public GridWriter {
public:
    MiniseedGrid(const Write& write, int rate_hz, const journal::StationCodes& codes,
                 const std::string& channel)
        : GridWriter(write, rate_hz) {
        header_.network = codes.network;
        header_.station = codes.station;
        header_.location = kProductLocation;
        header_.channel = channel;
        header_.nominal_rate = Hertz(rate_hz);
    }
    void end_run() override {
        while (!counts_.empty()) pack();
    }

private:
    void put(const GridRun& run) override {
        if (counts_.empty()) first_ = run.first;
        for (const double value : run.values) {
            counts_.push_back(static_cast<std::int32_t>(
                std::llround(std::clamp(value, -2147483648.0, 2147483647.0))));
            if (counts_.size() == archive::kMostSamplesPerRecord) pack();
        }
    }
    void pack() {
        header_.start = time_of(first_);
        const archive::PackedRecord packed = archive::pack_record(header_, counts_);
        write({reinterpret_cast<const char*>(packed.bytes.data()), packed.bytes.size()});
        counts_.erase(counts_.begin(),
                      counts_.begin() + static_cast<std::ptrdiff_t>(packed.sample_count));
        first_ += static_cast<std::int64_t>(packed.sample_count);
        header_.sequence = header_.sequence % 999999 + 1;
    }

    archive::RecordHeader header_;
    std::vector<std::int32_t> counts_;
    std::int64_t first_ = 0;
};

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

/// Returns the value of one count in the unit.
/// @throws InputError  the channel has another kind of unit, or the format has counts only.
double scale_of(const ExportOptions& options, const station::Metadata& metadata) {
    if (options.unit == "counts") return 1.0;
    const auto refuse = [&](std::string_view trouble) {
        throw InputError(fmt::format("--unit = {}: {}; allowed: counts", options.unit, trouble));
    };
    if (options.format == ExportFormat::mseed) refuse("records of miniSEED hold whole counts");
    const auto channel =
        std::ranges::find(metadata.channels, options.channel, &station::ChannelScale::code);
    if (channel == metadata.channels.end() || channel->unit != "m/s**2")
        refuse(options.channel + " is not a channel of acceleration");
    const double mgal = kMilliGalPerMps2 * channel->gain;
    constexpr double kMgPerStandardGravity = 1000.0;
    return options.unit == "mgal" ? mgal
                                  : mgal / kMilliGalPerStandardGravity * kMgPerStandardGravity;
}

}  // namespace

ExportReport export_channel(const ExportOptions& options,
                            const std::function<void(std::string_view)>& write) {
    const auto metadata =
        station::read_station_xml(options.root / "metadata" / "station.xml", options.from);
    const double scale = scale_of(options, metadata);
    std::unique_ptr<GridWriter> writer;
    if (options.format == ExportFormat::csv) {
        writer = std::make_unique<CsvGrid>(write, options.rate_hz, options.unit, scale);
    } else {
        writer =
            std::make_unique<MiniseedGrid>(write, options.rate_hz, metadata.codes, options.channel);
    }
    ExportReport report;
    std::optional<UtcGrid> grid;
    double source_rate_hz = 0.0;
    for (UtcTime begin = options.from; begin < options.to;) {
        const UtcTime end =
            std::min<UtcTime>(options.to, std::chrono::floor<days>(begin) + days(1));
        // The kernel needs 32 zero crossings on either side: 32 s at 1 Hz.
        const std::chrono::seconds margin(33 / options.rate_hz + 1);
        const archive::ChannelData data =
            archive::read_channel(options.root / "archive", metadata.codes, options.channel,
                                  begin - margin, end + margin);
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
            writer->take(grid->resample(segment, begin, end), report);
        }
        note(report, data.damage);
        begin = end;
    }
    if (report.values == 0) {
        throw InputError(fmt::format("{}: no samples of {} from {} to {}", options.root.string(),
                                     options.channel, to_rfc3339(options.from),
                                     to_rfc3339(options.to)));
    }
    writer->end_run();
    return report;
}

}  // namespace a351::corrector::resampling
