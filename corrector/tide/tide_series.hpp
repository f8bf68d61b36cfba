#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

/// Longer steps are a gap; with these the interpolation still is off by less than 0.0002 mGal.
inline constexpr std::chrono::seconds kLongestTideStep{3600};

/// A tide, or any other correction series, from outside: its effect on gravity, the same at all
/// sites.  Positive means that gravity is larger; to remove it from a reading, subtract it.
///
/// Between the rows the cubic through the four nearest ones (two on either side; at an end or
/// beside a gap four on one side).  Error against the model that was sampled, at Tsukuba, whole
/// month (tide_series_test.cpp): 0.00000012 mGal for steps of 10 minutes, 0.00016 of an hour; linear
/// interpolation of the former would have 0.0001.
class TideSeries {
public:
    /// Reads `time,tide_mgal`, time RFC 3339 with zone, ascending; steps need not be equal.
    /// @throws InputError  fewer than four rows, a time that does not ascend, a tide beyond 1 mGal.
    [[nodiscard]] static TideSeries read(const std::filesystem::path& file);

    /// The value at an instant; std::nullopt outside the series, in a gap, or where the four rows
    /// about it are not without a gap.
    [[nodiscard]] std::optional<MilliGal> at(UtcTime time) const;

    [[nodiscard]] UtcTime first() const { return times_.front(); }
    [[nodiscard]] UtcTime last() const { return times_.back(); }

private:
    [[nodiscard]] bool has_gap(std::size_t first) const;
    [[nodiscard]] MilliGal cubic(std::size_t first, UtcTime time) const;

    std::vector<UtcTime> times_;
    std::vector<double> values_mgal_;
};

}  // namespace a351::corrector
