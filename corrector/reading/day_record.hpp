#pragma once
/// @file
/// Input of the whole-day model: the temperature of the day, drives included, and the readings of
/// every set-up as means of 50 s.

#include <cstddef>
#include <optional>
#include <vector>

#include "corrector/reading/decimated_axes.hpp"
#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

/// Means over the undisturbed samples of 50 s, the period of the ripple that the publication saw.
struct DayBin {
    std::size_t set_up = 0;      ///< Number of the set-up in the day, from 0, in order of time.
    UtcTime time;                ///< Mean of its samples' times.
    std::vector<UtcTime> times;  ///< Times of the 2 s samples that it averages.
    MilliGal reading;            ///< Mean norm of the decimated axes.
    StandardGravity x, y;        ///< Means of the horizontal axes.
};

/// Number of 2 s samples in a complete bin, 50 s.
inline constexpr std::size_t kBinSamples = 25;

/// Returns the bins of a set-up; bins with fewer than eight samples are left out.
///
/// A sample is used if all axes are valid and no disturbance (find_disturbances()) is within 10 s,
/// the reach of the decimation filters (tests/unit/whole_day/day_record_test.cpp).
/// @param axes       decimate_axes() of the set-up, in g; missing samples NaN.
/// @param threshold  threshold of find_disturbances(), > 0.
/// @return the bins in order of time; none without valid samples.
[[nodiscard]] std::vector<DayBin> bin_set_up(std::size_t set_up, const DecimatedAxes& axes,
                                             double threshold);

/// The temperature of a day, decimated to 1/100 of the rate and smoothed with a cut-off of 120 s,
/// so that the noise of the thermometer does not become noise of the temperature rate.
struct DayTemperature {
    TimeSeries<DegC> series;     ///< Temperature without gaps.
    double longest_gap_s = 0.0;  ///< Longest gap bridged by a straight line, s.
};

/// Decimates and smooths the temperature of a day.
///
/// Gaps longer than 60 s (half the cut-off) separate pieces, which are smoothed one by one.  A
/// piece shorter than the cut-off is not smoothed.  The smoother fills the gaps within a piece; all
/// others are bridged by straight lines.
///
/// With thermometer noise of 0.01 degC per sample the result is within 0.0015 degC of a ramp, also
/// over a gap of 300 s (tests/unit/whole_day/day_record_test.cpp).
/// @param raw  temperature at the sensor's rate, missing samples NaN.
/// @return the temperature from the first valid sample to the last; std::nullopt with less than ten
///         minutes of valid samples.
[[nodiscard]] std::optional<DayTemperature> day_temperature(const TimeSeries<DegC>& raw);

/// A day as the whole-day model takes it.
struct DayRecord {
    DayTemperature temperature;
    std::vector<DayBin> bins;  ///< Bins in order of set-up and time.
};

}  // namespace a351::corrector
