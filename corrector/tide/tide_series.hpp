#pragma once
/// @file
/// Tide as a series from a file.
///
/// Use it for a tide that direct_tide() does not have, as ocean loading, or to repeat the tide of
/// another program.  Steps of 10 minutes are short enough:
///
///     time,tide_mgal
///     2017-07-16T00:00:00Z,0.0061
///     2017-07-16T00:10:00Z,0.0078
///     ...
///
///     const Series series = Series::read("tide.csv");
///     const std::optional<MilliGal> tide = series.at(time);     // absent: not covered

#include <filesystem>
#include <optional>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector::tide {

/// Longest step between rows, s; a longer one is a gap.  Reason: with this step the interpolation
/// error is below 0.0002 mGal (tide_series_test.cpp).
inline constexpr std::chrono::seconds kLongestTideStep{3600};

/// A tide, or any other correction series, from another program: its effect on gravity, the same at
/// all sites.  Positive if gravity is larger; to remove it from a reading, subtract it.
///
/// Between rows the value is the cubic through the four nearest rows: two on either side, or four
/// on one side at an end or beside a gap.  A cubic is reproduced, also with unequal steps
/// (tide_series_test.cpp).
///
/// Accuracy: difference from the model that was sampled, at Tsukuba over a month.  For steps of
/// 10 minutes 0.00000012 mGal (tide_series_test.cpp: below 2e-7), for steps of an hour 0.00016 mGal
/// (below 2e-4).  Linear interpolation of 10-minute steps would have 0.0001 mGal.
///
/// Invariant of an object from read(): at least four rows, in strictly ascending time, all finite.
/// A default-constructed object has no rows, and none of its functions may be called.  A constant
/// object may be used by several threads.
class Series {
public:
    /// Reads the columns `time` (RFC 3339 with zone, ascending) and `tide_mgal` (-1 to 1) of a CSV.
    /// Steps need not be equal.
    /// Other columns are ignored.  Blank lines are permitted.  A step beyond kLongestTideStep is no
    /// error; it makes a gap.
    /// @throws InputError  if there are fewer than four rows, a time is not valid or not after the
    ///                     row before it, or a tide is no number or beyond 1 mGal; with line and
    ///                     value.  Also if a column is missing or the file cannot be read.
    [[nodiscard]] static Series read(const std::filesystem::path& file);

    /// Returns the value at a time.  At the first and last row it is defined.
    /// At a row it is the row's value, to rounding.  The last row before a gap counts as in the
    /// gap, the first row after it does not.  Nothing is extrapolated.  The cost is O(log n).
    /// @return std::nullopt outside the series, in a gap, or if there are no four rows without a
    ///         gap among which the time lies.
    [[nodiscard]] std::optional<MilliGal> at(UtcTime time) const;

    /// Returns the time of the first row.
    [[nodiscard]] UtcTime first() const { return times_.front(); }
    /// Returns the time of the last row.
    [[nodiscard]] UtcTime last() const { return times_.back(); }

private:
    [[nodiscard]] bool has_gap(std::size_t first) const;
    [[nodiscard]] MilliGal cubic(std::size_t first, UtcTime time) const;

    std::vector<UtcTime> times_;
    std::vector<double> values_mgal_;
};

}  // namespace a351::corrector::tide
