#include "corrector/long_record/csv_record.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "corrector/long_record/stretch_builder.hpp"
#include "corrector/reading/smoother.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/core/sensor_limits.hpp"
#include "protocol/signal/median.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/csv_reader.hpp"
#include "protocol/text/input_file.hpp"
#include "protocol/text/text_file.hpp"

namespace a351::corrector::long_record {
namespace {

constexpr std::size_t kBlockRows = 16384;
constexpr std::size_t kFirstRows = 1000;  // rows from whose steps the rate is found, despite gaps
constexpr double kStepTolerance = 0.1;    // relative

/// A row of the table.
struct Row {
    std::size_t line = 0;  ///< Number of its line in the file.
    UtcTime time;
    std::vector<double> values;  ///< Axes or norm in mGal, then the temperature in degC.
};

/// The rows of the table within the window.
class Rows {
public:
    Rows(const std::filesystem::path& file, const RecordWindow& window)
        : in_(text::open_file(file)), reader_(in_, file), window_(window) {
        const auto& columns = reader_.columns();
        const auto has = [&](const char* name) {
            return std::ranges::find(columns, name) != columns.end();
        };
        const auto index = [&](const char* name) {
            return text::column_index(columns, name, file);
        };
        time_ = index(has("time") ? "time" : has("time_s") ? "time_s" : "time_utc");
        const bool has_axes = has("x_g") || has("y_g") || has("z_g");
        values_ = has_axes ? std::vector{index("x_g"), index("y_g"), index("z_g")}
                           : std::vector{index("acceleration_mgal")};
        if (has_axes) unit_mgal_ = kMilliGalPerStandardGravity;
        values_.push_back(index("temperature_degc"));
    }

    [[nodiscard]] std::size_t axes() const { return values_.size() - 1; }

    /// Reads the next row in the window; returns false at the end.
    [[nodiscard]] bool read(Row& row) {
        while (reader_.next()) {
            row.time = reader_.instant(time_);
            if (last_ && row.time <= *last_)
                reader_.refuse(time_, "not after the row before it", "times that ascend");
            last_ = row.time;
            if ((window_.from && row.time < *window_.from) ||
                (window_.to && row.time >= *window_.to))
                continue;
            row.line = reader_.line();
            row.values.clear();
            for (const std::size_t column : values_)
                row.values.push_back(reader_.sample(column, reading::kLargestSample) *
                                     (column == values_.back() ? 1.0 : unit_mgal_));
            return true;
        }
        return false;
    }

    [[nodiscard]] std::size_t bytes_read() {
        const auto position = in_.tellg();
        return position < 0 ? 0 : static_cast<std::size_t>(position);
    }

private:
    std::ifstream in_;
    text::CsvReader reader_;
    const RecordWindow& window_;
    std::size_t time_ = 0;
    std::vector<std::size_t> values_;
    double unit_mgal_ = 1.0;
    std::optional<UtcTime> last_;
};

/// Puts rows on the steps of their clock and builds stretches.  Refuses rows that have another step
/// than the first ones: they would get wrong times.
class CsvStream {
public:
    CsvStream(LongRecord& record, double step_s, int stages, std::size_t axes)
        : record_(record), step_s_(step_s), stages_(stages), axes_(axes), block_(axes + 1) {}

    void take(const Row& row) {
        if (steps_.empty()) first_line_ = row.line;
        if (last_) {
            const double passed_s = seconds_between(*last_, row.time);
            const double steps = passed_s / step_s_;
            // Missing rows do not change the step.
            if (passed_s <= kLongestGap_s)
                steps_.push_back(passed_s / std::max(1.0, std::round(steps)));
            if (steps_.size() == kCheckedRows) check_step();
            // A row after less than half a step is jitter of the time stamps: it is the next row.
            const auto missing = static_cast<std::size_t>(std::max(std::llround(steps) - 1, 0LL));
            if (steps * step_s_ > kLongestGap_s)
                end_stretch();
            else
                for (auto& channel : block_) channel.insert(channel.end(), missing, kNaN);
        }
        if (!builder_) builder_.emplace(stages_, axes_);
        const std::int64_t number = builder_->input_count() + static_cast<std::int64_t>(pending());
        if (number % builder_->inputs_per_sample() == 0)
            builder_->set_time(number / builder_->inputs_per_sample(), row.time);
        for (std::size_t k = 0; k < block_.size(); ++k) block_[k].push_back(row.values[k]);
        last_ = row.time;
        if (pending() >= kBlockRows) flush();
    }

    /// Ends the record after at least one row.
    void finish() {
        if (steps_.size() >= kFewestChecked) check_step();
        end_stretch();
    }

private:
    // Rows whose median step is checked; many rows, because stamps may jitter.
    static constexpr std::size_t kCheckedRows = 100, kFewestChecked = 20;

    [[nodiscard]] std::size_t pending() const { return block_.front().size(); }

    void flush() {
        builder_->push(block_);
        for (std::vector<double>& channel : block_) channel.clear();
    }

    void end_stretch() {
        flush();
        record_.stretches.push_back(builder_->finish(record_.step_s));
        builder_.reset();
    }

    void check_step() {
        const double step_s = signal::median(std::move(steps_));
        if (std::abs(step_s / step_s_ - 1.0) > kStepTolerance)
            throw InputError(fmt::format(
                "{}:{}: a row every {} s from about here on, every {} s elsewhere; allowed: one "
                "step in a file, within 10 %",
                record_.source.string(), first_line_, text::shortest(step_s),
                text::shortest(step_s_)));
        steps_.clear();
    }

    LongRecord& record_;
    double step_s_;
    int stages_;
    std::size_t axes_;
    std::optional<StretchBuilder> builder_;
    std::vector<std::vector<double>> block_;
    std::optional<UtcTime> last_;
    std::vector<double> steps_;   ///< Steps between the rows since the last check, s.
    std::size_t first_line_ = 0;  ///< Line of the first of these rows.
};

/// Refuses a norm in another unit than mGal: its median is gravity in that unit, and it scatters by
/// less than 0.01 of it.  In mGal the noise of a sensor at 20 s is ten times as large; in Gal, the
/// smallest of these units, 0.01 are 10 mGal.
void refuse_other_unit(const LongRecord& record) {
    constexpr double kLeastScatter = 0.01;
    constexpr std::array<std::pair<std::string_view, double>, 3> kUnits{
        {{"m/s2", kMilliGalPerMps2}, {"Gal", kMilliGalPerGal}, {"g", kMilliGalPerStandardGravity}}};
    std::vector<double> values;
    for (const RecordStretch& stretch : record.stretches)
        std::ranges::copy_if(stretch.quantity, std::back_inserter(values),
                             [](double value) { return !std::isnan(value); });
    if (values.empty()) return;
    const double median = signal::median(values);
    for (double& value : values) value = std::abs(value - median);
    if (signal::median(std::move(values)) >= kLeastScatter) return;
    for (const auto& [unit, mgal] : kUnits)
        if (is_norm_believable(to_standard_gravity(MilliGal(median * mgal))))
            throw InputError(fmt::format(
                "{}: acceleration_mgal: the median is {:.6g}, which is gravity in {}; allowed: "
                "mGal (add a constant if they only look so)",
                record.source.string(), median, unit));
}

}  // namespace

std::optional<int> record_stages(double step_s) {
    double step = kRecordStep_s;
    for (int stages = 0; stages <= kMostRecordStages; ++stages, step /= kRecordFactor)
        if (std::abs(step_s / step - 1.0) < kStepTolerance) return stages;
    return std::nullopt;
}

LongRecord read_csv_record(const std::filesystem::path& file, const RecordWindow& window,
                           const archive_series::Progress& progress) {
    constexpr std::size_t kMegabyte = 1'000'000;
    Rows rows(file, window);
    std::vector<Row> first;
    Row row;
    while (first.size() < kFirstRows && rows.read(row)) first.push_back(row);
    if (first.size() < 2)
        throw InputError(file.string() +
                         ": fewer than two rows; allowed: a record from --from to --to");
    std::vector<double> steps;
    for (std::size_t i = 1; i < first.size(); ++i)
        steps.push_back(seconds_between(first[i - 1].time, first[i].time));
    const double step_s = signal::median(std::move(steps));
    const auto stages = record_stages(step_s);
    if (!stages)
        throw InputError(
            fmt::format("{}: a row every {} s; allowed: every 0.02, 0.2, 2 or 20 s within 10 %",
                        file.string(), text::shortest(step_s)));

    LongRecord record;
    record.source = file;
    record.raw_rate_hz = 1.0 / step_s;
    record.step_s = step_s * std::pow(kRecordFactor, *stages);
    CsvStream stream(record, step_s, *stages, rows.axes());
    for (const Row& early : first) stream.take(early);
    const std::size_t megabytes = std::filesystem::file_size(file) / kMegabyte;
    for (std::size_t count = 0; rows.read(row); ++count) {
        stream.take(row);
        if (count % kBlockRows == 0) progress(rows.bytes_read() / kMegabyte, megabytes);
    }
    stream.finish();
    if (rows.axes() == 1) refuse_other_unit(record);
    record.inputs.push_back(text::describe_input("record", file));
    return record;
}

}  // namespace a351::corrector::long_record
