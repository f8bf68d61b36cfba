#include "corrector/command/sample_column.hpp"

#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "corrector/reading/smoother.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::command {
namespace {

constexpr std::size_t kBlock = 16384;  // samples: 128 kB

/// Largest deviation of a step, in mean steps: time stamps of a host scatter less, a missing row
/// doubles a step.
constexpr double kMostStepError = 0.25;

std::ifstream open(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw InputError(file + ": cannot be read; allowed: a readable file");
    return in;
}

std::optional<std::size_t> find_time(const std::vector<std::string>& columns) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i] == "time" || columns[i] == "time_utc" || columns[i] == "time_s") return i;
    }
    return std::nullopt;
}

double seconds_of(Nanoseconds time) { return std::chrono::duration<double>(time).count(); }

std::string in_seconds(Nanoseconds time) { return text::shortest(seconds_of(time)) + " s"; }

}  // namespace

SampleColumn::SampleColumn(const std::string& file, const std::string& column, Missing missing)
    : missing_(missing),
      in_(open(file)),
      reader_(in_, file),
      column_(text::column_index(reader_.columns(), column, file)),
      time_column_(find_time(reader_.columns())) {
    reader_.expect_numbers(column_);
    if (std::filesystem::is_regular_file(file)) byte_count_ = std::filesystem::file_size(file);
}

bool SampleColumn::read(std::vector<double>& samples) {
    samples.clear();
    while (samples.size() < kBlock && reader_.next()) {
        if (time_column_) check_time();
        const std::string_view cell = reader_.cells()[column_];
        if (cell.empty() && missing_ == Missing::refused)
            reader_.refuse(column_, "missing", "a number in each row");
        if (cell.empty()) {
            ++missing_count_;
            samples.push_back(std::numeric_limits<double>::quiet_NaN());
            continue;
        }
        const std::optional<double> value = reader_.number(column_);
        if (!value || std::abs(*value) > reading::kLargestSample) {
            reader_.refuse(column_, value ? "out of range" : "not a finite number",
                           "a number with a decimal point, at most 1e150 in magnitude, or nothing "
                           "for a missing sample");
        }
        samples.push_back(*value);
    }
    count_ += samples.size();
    return !samples.empty();
}

std::size_t SampleColumn::bytes_read() {
    const auto position = in_.tellg();
    return position < 0 ? byte_count_ : static_cast<std::size_t>(position);
}

void SampleColumn::check_time() {
    const std::size_t column = *time_column_;
    const Nanoseconds time = reader_.instant(column).time_since_epoch();
    if (last_time_) {
        const Nanoseconds step = time - *last_time_;
        if (step <= Nanoseconds(0))
            reader_.refuse(column, "not after the row before it", "times that ascend");
        // The first step may span a missing row, so each step is compared with the mean of all
        // before.
        const Nanoseconds mean =
            step_count_ == 0 ? step : (*last_time_ - *first_time_) / step_count_;
        if (std::abs(seconds_of(step - mean)) > kMostStepError * seconds_of(mean)) {
            reader_.refuse(column, in_seconds(step) + " after the row before it",
                           fmt::format("equal steps, here of {}; a missing sample has a row with "
                                       "an empty cell",
                                       in_seconds(mean)));
        }
        ++step_count_;
    } else {
        first_time_ = time;
    }
    last_time_ = time;
}

}  // namespace a351::corrector::command
