#pragma once
/// @file
/// The states of both lags at the end of a gap of the temperature.  They are unknown.
///
/// In a gap the temperature is taken as a straight line, which misses what the oven and the weather
/// did.  After the gap the temperature is known again, but the lags remember:
///
///     lag(T, tau) = lag(line, tau) + e exp(-(t - t_end) / tau),   t >= t_end
///
/// e is unknown, so the whole-day model estimates its effect on the reading, one for each lag and
/// gap, with a prior from the day itself: other stretches of the same length are bridged as if they
/// were gaps.

#include <vector>

#include "corrector/reading/day_record.hpp"

namespace a351::corrector::whole_day {

/// The lags after one gap.
struct LagStates {
    UtcTime from;         ///< First sample after the gap.
    double fast_sd_degc;  ///< Standard deviation of e for the fast lag.
    double slow_sd_degc;  ///< The same for the slow lag.
};

/// Returns the states after each gap, in order of time; none without gaps.
///
/// A deviation is the rms of e over all stretches of the gap's length that contain no gap, one each
/// 30 samples; with none, the standard deviation of the temperature, at least 0.1 degC.  It assumes
/// that the temperature behaves in the gap as in the rest of the record, and that the sensor stayed
/// powered: a new warm-up is not part of it.
///
/// Accuracy (lag_states_test.cpp): on a random course of temperature the rms of the true e over 200
/// gaps of an hour agrees within 15 %, for lags of 43 s and 2700 s.
/// @param temperature  of the day; finite.
/// @param fast_lag_s   tF, s, > 0.
/// @param slow_lag_s   tS, s, > 0.
[[nodiscard]] std::vector<LagStates> lag_states(const reading::DayTemperature& temperature,
                                                double fast_lag_s, double slow_lag_s);

/// Returns exp(-(t - from) / lag) as a mean over the samples of a bin; samples before `from`
/// count 0.
///
/// The result is 0 to 1.  Accuracy: rounding; 0 before `from`, e^-1 after one lag
/// (lag_states_test.cpp).
/// @param bin    at least one sample; without one the result is NaN.
/// @param lag_s  s, > 0; not checked.
[[nodiscard]] double remaining(const reading::DayBin& bin, UtcTime from, double lag_s);

}  // namespace a351::corrector::whole_day
