#pragma once
/// @file
/// Input of the whole-day model: the temperature of the day, drives included, and the readings of
/// every set-up as means of 50 s.
///
/// The whole-day model (corrector/whole_day) fits all bins of a day at once, so it needs the
/// temperature between the set-ups too.  Order of use:
///
///     DayRecord day{*day_temperature(raw_temperature), {}};
///     for (std::size_t i = 0; i < set_ups; ++i)
///         for (DayBin& bin : bin_set_up(i, axes[i], kDisturbanceThreshold))
///             day.bins.push_back(std::move(bin));
///
/// average_occupations() does this for a survey.

#include <cstddef>
#include <optional>
#include <vector>

#include "corrector/reading/decimated_axes.hpp"
#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector::reading {

/// Means over the undisturbed samples of 50 s, the period of the ripple that the publication saw.
/// Invariant of a bin from bin_set_up(): eight to kBinSamples samples, and no NaN.  A
/// default-constructed bin has no samples.
struct DayBin {
    std::size_t set_up = 0;      ///< Number of the set-up in the day, from 0, in order of time.
    UtcTime time;                ///< Mean of its samples' times.
    std::vector<UtcTime> times;  ///< Times of the 2 s samples that it averages.
    MilliGal reading;            ///< Mean norm of the decimated axes.
    StandardGravity x, y;        ///< Means of the horizontal axes.
    double face = 1.0;           ///< events::face_of() its set-up.
    MilliGal tide;               ///< Effect of the tide on gravity at `time`; to be subtracted.
};

/// Number of 2 s samples in a complete bin, 50 s.  Reason: the ripple averages out over its period.
inline constexpr std::size_t kBinSamples = 25;

/// Returns the bins of a set-up; bins with fewer than eight samples are left out.
///
/// A sample is used if all axes are valid and no disturbance (find_disturbances()) is within 10 s,
/// the reach of the decimation filters (tests/unit/whole_day/day_record_test.cpp).
///
/// Bins follow each other from the first sample of the set-up, so the last one can be incomplete.
/// The mean time is that of the samples used, not the middle of the 50 s.
///
/// The norm is that of the decimated axes.  The horizontal means show the tilt.  The times
/// of 50 and 10 s are those of axes recorded at 50 Hz; at other rates they are 25 and 5 samples.
///
/// @param set_up     number that the bins get; not used otherwise.
/// @param axes       decimate_axes() of the set-up, in g; missing samples NaN.
/// @param threshold  threshold of find_disturbances(), > 0; kDisturbanceThreshold in a survey.
/// @return the bins in order of time; none without valid samples.
/// @throws std::invalid_argument  the axes differ in start, rate or length.
[[nodiscard]] std::vector<DayBin> bin_set_up(std::size_t set_up, const DecimatedAxes& axes,
                                             double threshold);

/// A stretch of a series that is a straight line between two samples.
struct TemperatureGap {
    std::size_t before = 0,
                after = 0;  ///< Numbers of the last sample before it and the first after.
};

/// The temperature of a day, decimated to 1/100 of the rate and smoothed with a cut-off of 120 s,
/// so that the noise of the thermometer does not become noise of the temperature rate.
/// Invariant of the result of day_temperature(): every value is finite.  The delay of the smoother
/// is zero.
struct DayTemperature {
    TimeSeries<DegC> series;  ///< Temperature without gaps.
    /// Gaps between the pieces, in order of time.  The filters make a gap of the raw samples longer
    /// by about 18 s at 50 Hz.
    std::vector<TemperatureGap> gaps;

    /// Returns the duration of the longest gap, s; 0 if there is none.
    [[nodiscard]] double longest_gap_s() const;
    /// Returns true if an instant is inside a gap.
    [[nodiscard]] bool is_bridged(UtcTime time) const;
};

/// Smooths the decimated temperature of a day.
///
/// Gaps longer than 60 s (half the cut-off) separate pieces, which are smoothed one by one.  A
/// piece shorter than the cut-off is not smoothed.  The smoother fills the gaps within a piece; all
/// others are bridged by straight lines.
///
/// With thermometer noise of 0.01 degC per sample the result is within 0.0015 degC of a ramp, also
/// over a gap of 300 s (tests/unit/whole_day/day_record_test.cpp).
/// @param decimated  temperature at 1 / kDecimationRatio of the sensor's rate, 0.1 to 40 Hz; missing
///                   samples NaN.
/// @return the temperature from the first valid sample to the last; std::nullopt with less than ten
///         minutes of valid samples.  Gaps within a piece count as valid.
/// @throws std::invalid_argument  as smooth(), at rates outside this range.
[[nodiscard]] std::optional<DayTemperature> day_temperature(const TimeSeries<DegC>& decimated);

/// Returns the faces of the set-ups (set_ups) of bins; 1 without a bin.
[[nodiscard]] std::vector<double> faces_of(const std::vector<DayBin>& bins, std::size_t set_ups);

/// Returns true if the sensor was turned over between bins.
[[nodiscard]] bool has_two_faces(const std::vector<DayBin>& bins);

/// A day as the whole-day model takes it.
/// The temperature should begin hours before the first set-up (a survey takes eight), because the
/// slow response to temperature has a long memory.
struct DayRecord {
    DayTemperature temperature;
    std::vector<DayBin> bins;  ///< Bins in order of set-up and time.
    /// Temperature of an outer oven on the grid of `temperature`, finite; absent if there is none, or
    /// if it has gaps (is_without_gaps() in temperature_course.hpp).
    std::optional<TimeSeries<DegC>> outer = {};
};

}  // namespace a351::corrector::reading
