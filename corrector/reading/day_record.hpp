#pragma once
/// @file
/// What the whole-day model is fitted to: the temperature of the day, drives included, and the
/// readings of every set-up in means of 50 s.

#include <cstddef>
#include <optional>
#include <vector>

#include "corrector/reading/decimated_axes.hpp"
#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

/// Means over the undisturbed samples of 50 s: a period of the ripple that the publication saw.
struct DayBin {
    std::size_t set_up = 0;      ///< Counts the set-ups of the day in order of time.
    UtcTime time;                ///< Mean of its samples' times.
    std::vector<UtcTime> times;  ///< Of the samples at 2 s that it averages.
    MilliGal reading;            ///< Mean norm of the decimated axes.
    StandardGravity x, y;        ///< Means of the horizontal axes.
};

/// Samples of a complete bin.
inline constexpr std::size_t kBinSamples = 25;

/// The bins of a set-up, those with fewer than eight samples left out.  A sample takes part where all
/// axes are valid and no disturbance (find_disturbances()) is nearer than 10 s, the reach of the
/// decimation filters.
/// @param axes       decimate_axes() of the set-up.
/// @param threshold  of a disturbance, > 0.
[[nodiscard]] std::vector<DayBin> bin_set_up(std::size_t set_up, const DecimatedAxes& axes,
                                             double threshold);

/// The course of the temperature: decimated to 1/100 of the rate and smoothed with a cut-off of
/// 120 s, so that the noise of the thermometer does not become noise of its rate.  Gaps longer than
/// that are bridged by straight lines.
struct DayTemperature {
    TimeSeries<DegC> series;     ///< Without a gap.
    double longest_gap_s = 0.0;  ///< That was bridged.
};

/// @param raw  at the sensor's rate, missing samples NaN.
/// @return std::nullopt with less than ten minutes of valid samples.
[[nodiscard]] std::optional<DayTemperature> day_temperature(const TimeSeries<DegC>& raw);

struct DayRecord {
    DayTemperature temperature;
    std::vector<DayBin> bins;  ///< In order of set-up and time.
};

}  // namespace a351::corrector
