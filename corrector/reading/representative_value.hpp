#pragma once
/// @file
/// From the 50 Hz record of one occupation to its representative value, with data to judge it.
///
/// The value is the mean of a slow trend, not of the samples.  At a disturbed end the average
/// begins or ends at a comparable phase of the slow oscillation (interval.hpp).
///
///     const DecimatedAxes axes = decimate_axes(record);
///     const auto value = representative_value(record, axes);
///     if (!value) leave_out();                            // too short
///     else use(value->curve_mean, value->flags);
///
/// average_occupations() does this for a whole survey.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "corrector/reading/decimated_axes.hpp"
#include "corrector/reading/interval_statistics.hpp"
#include "corrector/reading/trend_curve.hpp"
#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector::reading {

/// Limits of the smoother's cut-off, s.  Reason: a shorter one gives no trend.  A longer one
/// distorts the waves of an occupation, and would be too many samples for the smoother at 10 Hz.
/// Both limits are permitted.
inline constexpr double kShortestCutoff_s = 20.0;
inline constexpr double kLongestCutoff_s = 500.0;

/// Options of representative_value().
/// All default values are valid.
struct RepresentativeOptions {
    /// Order of norm and decimation; `as_published` adds the rectification bias to the value.
    NormOrder norm = NormOrder::decimate_first;
    /// Trend that gives the value and the interval.  The other one is computed too.
    TrendMethod trend = TrendMethod::eemd;
    TrendCurve curve = TrendCurve::slow;  ///< Trend curve of the decomposition.
    /// Cut-off period of the smoother, s, kShortestCutoff_s to kLongestCutoff_s.  Reason for 300:
    /// decimation.md, "Smoother".
    double cutoff_s = 300.0;
    std::uint64_t seed = 0;  ///< Seed of the decomposition's noise.
};

/// Threshold of find_disturbances() for an occupation, standard deviations.  Source: decimation.md,
/// "Interval".
inline constexpr double kDisturbanceThreshold = 8.0;

/// Doubts about an occupation, in this order.  None is an error: the value exists.
///
/// The flags `fallback` and `pulse` make a reading doubtful; `gap` and `unsettled` ask for care
/// (methods.md).  A disturbance at an end alone is no reason for doubt.  Without temperature a
/// value cannot be corrected, so it gets no row in a survey.
enum class OccupationFlag {
    fallback,         ///< The trend has too few extrema; choose_interval() used a fallback.
    disturbed_start,  ///< The interval begins after a disturbance.
    disturbed_end,    ///< A disturbance is near the end; the interval ends before it.
    pulse,            ///< A disturbance inside split the record; the longest part was used.
    gap,              ///< Samples are missing within the occupation.
    no_temperature,   ///< The interval has fewer than two valid temperatures.
    unsettled,        ///< The value is the smoother's, and its weights did not settle.
};

/// Returns the flag's name in tables, which is that in the enumeration.
/// @param flag  one of the enumerators; another value is not checked.
[[nodiscard]] std::string_view flag_name(OccupationFlag flag) noexcept;

/// Numbers of decimated samples of an occupation, by the raw samples under both filters.
/// The three add up to the length of RepresentativeValue::series.  A complete record has nine or
/// ten partial ones, at the ends.
struct SampleCounts {
    std::size_t valid = 0;    ///< All raw samples exist.
    std::size_t partial = 0;  ///< Some raw samples are missing or outside the record.
    std::size_t missing = 0;  ///< No raw sample exists.
};

/// Statistics of the record of an occupation, within the averaging interval unless stated
/// otherwise.
///
/// The four means are of the same interval.  They differ by what each trend removes.
/// smoother_minus_eemd() beyond 0.5 mGal is a reason to look at the record.
///
/// Both standard errors describe how well the samples determine the mean.  Neither includes
/// placement, temperature or drift.
struct RecordSummary {
    MilliGal series_mean;              ///< Mean of the decimated norm.
    MilliGal curve_mean;               ///< Mean of the trend chosen by the options: the value.
    MilliGal eemd_mean;                ///< Mean of the decomposition's trend.
    MilliGal smoother_mean;            ///< Mean of the smoother's trend.
    MilliGal smoother_standard_error;  ///< Standard error of smoother_mean, for white noise.
    /// Standard error of series_mean, from blocks of 60 s; absent with fewer than two blocks.
    std::optional<MilliGal> standard_error;
    /// Range of the decimated temperature; 0 without temperature.
    DegC temperature_range;
    /// Shape of the decimated temperature; meaningless without temperature.
    TemperatureShape temperature_shape = TemperatureShape::monotone;
    SampleCounts counts;      ///< Counts over the whole occupation.
    double recorded_s = 0.0;  ///< Length of `series`, the whole occupation.
    AxisSummary x, y, z;      ///< Axes; z is along gravity.
    /// rectification_bias() of the axes; part of the value if NormOrder::as_published.
    MilliGal rectification;

    /// Returns the difference of both trends' means, positive if the smoother's is larger.
    [[nodiscard]] MilliGal smoother_minus_eemd() const { return smoother_mean - eemd_mean; }
};

/// The value of one occupation, which is its curve_mean, and data to judge it.
///
/// The mean of `curve` over the interval is curve_mean.  The curve has its own start, that of the
/// decomposed part; the interval is in times, so that it fits all series.
struct RepresentativeValue : RecordSummary {
    /// Summary of the decimated temperature; absent with fewer than two valid samples.
    std::optional<TemperatureSummary> temperature;
    UtcTime interval_start;             ///< Time of the first sample of the interval.
    UtcTime interval_end;               ///< Time of the last sample of the interval.
    std::vector<OccupationFlag> flags;  ///< Doubts, in the order of the enumeration.
    TimeSeries<MilliGal> series;  ///< Decimated norm of the whole record, at 1 / 100 of its rate.
    TimeSeries<MilliGal> curve;   ///< Trend of the decomposed part, by the method of the options.
    TimeSeries<DegC> temperature_series;  ///< Decimated temperature, at the instants of `series`.
};

/// Returns the representative value of an occupation, or nothing if its record is too short.
///
/// 1. Decimates the axes twice by 10 and takes their norm (the order is an option).
/// 2. Takes the longest run of valid samples, and of it the longest part between pulses.
/// 3. Decomposes this part (EEMD of 80 members, noise ratio 0.1, ten sifts) and smooths it.
/// 4. Chooses the interval by the trend curve (interval.hpp).
/// 5. Averages both trends over the interval.
///
/// No gap is bridged: a missing sample (NaN) makes the decimated samples around it missing.  The
/// parts before and after it are not joined, and only the longest run is used.
///
/// Temperature beyond the axes is used by its filters only; the statistics are those of the
/// interval.  A record without temperature is accepted.
///
/// The function is pure: the same record, options and seed give the same bits, in any thread.  The
/// decomposition of 450 samples takes 3 ms on one core of a Zen 4 (eemd.md).
///
/// Accuracy, all shown by tests/unit/reading/representative_value_test.cpp:
/// - A constant without noise returns within 1e-6 mGal, a ramp with its value at mid-interval.
/// - White noise of 50 mGal at 50 Hz over 15 minutes: standard error 0.24 mGal; the value is within
///   four of them.
/// - A disturbance of 10 s and 100 to 10 000 mGal at an end or inside moves the value by less than
///   0.6 mGal, with noise of 20 mGal, and is flagged.
///
/// @param record   axes in g and temperature in degC at the sensor's rate; missing samples NaN.
/// @param axes     decimate_axes(record), which is not checked.
/// @param options  see RepresentativeOptions.
/// @return std::nullopt if the part has fewer than 16 samples (32 s at 50 Hz).  A record without
///         gaps needs 2452 raw samples for them.
/// @throws std::invalid_argument  the axes, or axes and temperature, are not on one grid; cutoff_s
///                                is out of range.
/// Method: S. Matsuda, K. Nakasendo, H. Morikawa, K. Iiyama and K. Sakai, "An experimental study on
/// basic performances of accelerometer with crystal oscillator" (in Japanese).  Different by
/// default: the order of norm and decimation, the trend curve and its mirrored ends (eemd.md).
/// Different always: disturbed samples next to the ends are replaced by the running median
/// (despike()) before the decomposition, because it would spread them over all components.
[[nodiscard]] std::optional<RepresentativeValue> representative_value(
    const OccupationRecord& record, const DecimatedAxes& axes,
    const RepresentativeOptions& options = {});

}  // namespace a351::corrector::reading
