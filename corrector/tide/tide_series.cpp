#include "corrector/tide/tide_series.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::tide {

constexpr std::size_t kPoints = 4;  // points that determine a cubic

Series Series::read(const std::filesystem::path& file) {
    const text::CsvTable table = text::read_csv(file);
    Series series;
    series.times_ = table.ascending_times("time");
    // No solid-Earth tide exceeds 0.3 mGal; the limit 1 finds a wrong unit.
    for (std::size_t row = 0; row < table.row_count(); ++row)
        series.values_mgal_.push_back(table.number(row, "tide_mgal", -1.0, 1.0));
    if (series.times_.size() < kPoints)
        throw InputError(
            fmt::format("{}: too few rows; allowed: {} or more", file.string(), kPoints));
    return series;
}

std::optional<MilliGal> Series::at(UtcTime time) const {
    if (time < first() || time > last()) return std::nullopt;
    const auto after = std::upper_bound(times_.begin(), times_.end(), time);
    const auto bracket = std::min(static_cast<std::size_t>(after - times_.begin()) - 1,
                                  times_.size() - 2);  // the row before `time`
    for (const std::size_t before : {1U, 2U, 0U}) {
        if (before > bracket || bracket - before + kPoints > times_.size()) continue;
        if (!has_gap(bracket - before)) return cubic(bracket - before, time);
    }
    return std::nullopt;
}

bool Series::has_gap(std::size_t first) const {
    for (std::size_t i = first + 1; i < first + kPoints; ++i)
        if (times_[i] - times_[i - 1] > kLongestTideStep) return true;
    return false;
}

/// Returns the cubic through four rows in Lagrange's form: sum_i y_i prod_(k != i) (t - t_k) / (t_i
/// - t_k).
MilliGal Series::cubic(std::size_t first, UtcTime time) const {
    double sum = 0.0;
    for (std::size_t i = first; i < first + kPoints; ++i) {
        double weight = 1.0;
        for (std::size_t k = first; k < first + kPoints; ++k) {
            if (k == i) continue;
            weight *= seconds_between(times_[k], time) / seconds_between(times_[k], times_[i]);
        }
        sum += weight * values_mgal_[i];
    }
    return MilliGal(sum);
}

}  // namespace a351::corrector::tide
