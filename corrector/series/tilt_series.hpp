#pragma once
/// @file
/// Biases of the horizontal axes from a series of tilted set-ups at one point
/// (corrector/methods.md, "Calibration").
///
/// A series is made at one point: each axis is tilted by a degree or two to both sides, one at a
/// time.  Each tilt is a set-up.  The temperature should be constant.
///
///     const TiltSeries first = measure_axis_bias(read_first, "monday");
///     const TiltSeries second = measure_axis_bias(read_second, "tuesday");
///     calibration.axis_bias = combine({first, second});

#include <string>
#include <vector>

#include "corrector/reading/occupation_rows.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector::series {

/// Axis biases from one series, and the facts about the series.  Tilts and temperatures are those
/// of the set-ups used.
struct TiltSeries {
    unit::AxisBias bias;      ///< Biases of x and y, mGal/g, with their covariance.
    std::size_t set_ups = 0;  ///< Number of set-ups used.
    std::array<double, 2> least_tilt_deg{}, greatest_tilt_deg{};  ///< Tilts about x and y.
    double temperature_range_degc = 0.0;  ///< Range of the set-ups' temperatures.
    double placement_mgal = 0.0;          ///< Scatter of set-ups, estimated by the fit.
};

/// Measures the biases of the horizontal axes.
///
/// The whole-day model with gravity held is fitted to |m - b|, where m is the mean vector of a bin
/// and b the biases.  This is repeated three times with the biases found before, so that no
/// small-angle approximation remains.  b_z is the mean reading minus gravity of the site; without a
/// known gravity standard gravity (980665 mGal) is taken, whose error is even in the tilt and does
/// not matter.  Flagged and excluded set-ups are not used.
///
/// The covariance contains the scatter of set-ups, flicker and the effect of the temperature.  With
/// a scatter of 1.2 mGal and four set-ups at 2 degrees, the standard error is 17 mGal/g within 40 %
/// (tilt_series_test.cpp).  Cost: three searches of adjust_day().
///
/// Accuracy (tilt_series_test.cpp): biases of -1200 and 700 mGal/g come out within 0.5 mGal/g for
/// twelve set-ups at 0 and 2 degrees, and within 2 mGal/g without the site's gravity.
/// @param read    rows and record of the series.  Flagged set-ups need bins too.
/// @param origin  name of the series, for messages.
/// @throws InputError  if set-ups are at several points or fewer than six, if the temperature
///                     between set-ups varies by more than 0.3 degC, if model::day_refusal() has a reason,
///                     if an axis is not tilted by 0.5 deg to both sides, or if both axes are only
///                     tilted together.
[[nodiscard]] TiltSeries measure_axis_bias(const reading::OccupationRows& read,
                                           const std::string& origin);

/// Returns the weighted mean of independent measurements: weights are the inverse covariances, and
/// the covariance is the inverse of their sum.
///
/// A single series is returned as it is.  Series that disagree do not enlarge the covariance.
///
/// Accuracy: rounding; the same series twice gives its values and half its covariance
/// (tilt_series_test.cpp).
/// @param series  at least one, with positive definite covariances.
/// @throws std::invalid_argument  one of several covariances is not positive definite.
[[nodiscard]] unit::AxisBias combine(const std::vector<TiltSeries>& series);

}  // namespace a351::corrector::series
