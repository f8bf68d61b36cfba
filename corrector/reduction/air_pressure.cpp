#include "corrector/reduction/air_pressure.hpp"

#include <algorithm>

#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"

namespace a351::corrector::reduction {

AirPressure AirPressure::read(const std::filesystem::path& file) {
    const text::CsvTable table = text::read_csv(file);
    AirPressure pressure;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        const auto time = parse_rfc3339(table.cell(row, "time"));
        if (!time) table.refuse(row, "time", "not an instant", "YYYY-MM-DDThh:mm:ss with zone");
        if (!pressure.times_.empty() && *time <= pressure.times_.back())
            table.refuse(row, "time", "not after the row before it", "ascending times");
        pressure.times_.push_back(*time);
        pressure.values_hpa_.push_back(
            table.number(row, "pressure_hpa", kLeastPressure_hpa, kGreatestPressure_hpa));
    }
    if (pressure.times_.size() < 2)
        throw InputError(file.string() + ": too few rows; allowed: 2 or more");
    return pressure;
}

std::optional<double> AirPressure::at(UtcTime time) const {
    if (time < times_.front() || time > times_.back()) return std::nullopt;
    const auto behind = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
    const auto i = static_cast<std::size_t>(behind - times_.begin());
    if (times_[i] - times_[i - 1] > kLongestPressureStep) return std::nullopt;
    const double share =
        seconds_between(times_[i - 1], time) / seconds_between(times_[i - 1], times_[i]);
    return values_hpa_[i - 1] + share * (values_hpa_[i] - values_hpa_[i - 1]);
}

}  // namespace a351::corrector::reduction
