#pragma once
/// @file
/// A band pass without phase shift.
///
/// Use it to look at the oscillations of a band in a long record.  Values near the ends depend on
/// the continuation beyond them.  For the slow part of a record use smooth() or trend_curve().
///
///     const std::vector<double> cycle = band_pass(readings, 20.0, 600.0, 1500.0);

#include <vector>

namespace a351::corrector::reading {

/// Filters a series with a second-order Butterworth band pass between two periods.
///
/// The filter runs forward and backward, so it shifts no phase.  Its gain is 1 at the centre of the
/// band, the geometric mean of both periods, and 1/2 at both periods, each within 0.005
/// (tests/unit/sim/signal/survey_day_test.cpp).  Before filtering, each end is continued by point
/// reflection over three of the longer periods, or over the whole series if that is shorter.
///
/// A NaN makes all values NaN.
///
/// Mean and drift are removed, because the gain is 0 at frequency 0; it is 0 at half the rate too.
/// For a band of 600 to 1500 s and steps of 20 s it is below 0.005 at 150 s and at 8000 s (same
/// test).
///
/// The time is O(n).  The last digits depend on the C library's tangent.  The arguments are not
/// checked; an empty series is not permitted.
///
/// @param values            (n) samples at constant rate, any unit; n >= 1.
/// @param step_s            time between two samples, s, > 0.
/// @param shorter_period_s  s, more than two steps.
/// @param longer_period_s   s, longer than shorter_period_s.
/// @return (n) values in the unit of the series.
/// Source: T. W. Parks and C. S. Burrus, Digital Filter Design, Wiley 1987, chap. 7: analogue
/// prototype, band-pass transformation, bilinear transformation with prewarped corners.
[[nodiscard]] std::vector<double> band_pass(const std::vector<double>& values, double step_s,
                                            double shorter_period_s, double longer_period_s);

}  // namespace a351::corrector::reading
