#pragma once
/// @file
/// Response of a unit's reading to its temperature T, and what is expected of a unit that nobody
/// has calibrated:
///
///     a = rA (T - T0) + rF (T - lag(T, tF)) / tF + rS (lag(T, tS) - T0)
///
/// a is in mGal, T in degC, rA and rS in mGal/degC, rF in mGal/(degC/h), the lags tF and tS in s.
/// - lag(T, tau): T behind a first-order lag, in equilibrium at the first sample.
/// - rA: rest of the thermometer's compensation.
/// - rF: crystals that feel a change before the thermometer.
/// - rS: an oscillator that feels a change later.
/// - T0: temperature without effect.  Another T0 only adds a constant to a.
///
/// A steady temperature gives (rA + rS) (T - T0).  A steady ramp of 1 degC/h gives rF mGal more,
/// and the slow term is late by tS.  A sudden step of 1 degC changes the fast term by
/// 3600 rF / tF, 946 mGal for a typical unit.  Therefore remove the thermometer's noise from T
/// before.
///
///     const ThermalEffect unit{-12.0, -20.0, 11.3};  // lags of the typical unit
///     const std::vector<double> effect_mgal = unit.of(temperature, kTypicalUnit.set_point_degc);
///
/// All functions are pure: any number of threads may call them.
///
/// The whole-day model, long records, the verdict and the calibration file all mean this response.
/// Origin of the figures: corrector/methods.md, "The whole-day model".

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <string_view>
#include <vector>

#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"

namespace a351::unit {

/// Parameters rA, rS, rF, ln tF, ln tS, in the order of calibrations and their covariances.
///
/// level and slow are in mGal/degC, fast is in mGal/(degC/h), both lags are ln(s).  The values are
/// indices from 0 for kThermalNames.
enum class ThermalTerm { level, slow, fast, fast_lag, slow_lag };
/// Names with units, in the order of ThermalTerm; lags as natural logarithms of seconds.
inline constexpr auto kThermalNames =
    std::to_array<std::string_view>({"temperature_mgal_per_degc", "slow_temperature_mgal_per_degc",
                                     "rate_mgal_per_degc_per_h", "fast_lag_ln_s", "slow_lag_ln_s"});
/// Number of parameters.  Other lists of them have this length, or do not compile.
inline constexpr std::size_t kThermalTerms = kThermalNames.size();

/// A unit of this type, as the published records show it.
///
/// How much another unit differs is not known; day_prior() allows for 60 %.  Use a
/// calibration (calibration.hpp) where the unit's own numbers matter.
struct TypicalUnit {
    double level_mgal_per_degc = -12.0;      ///< rA
    double slow_mgal_per_degc = -20.0;       ///< rS
    double fast_mgal_per_degc_per_h = 11.3;  ///< rF
    double fast_lag_s = 43.0;                ///< tF
    double slow_lag_s = 2700.0;              ///< tS
    double warm_up_mgal = 36.0;              ///< Effect at power-on that the thermometer misses.
    double warm_up_h = 2.5;                  ///< Time constant of its decay.
    double set_point_degc = 42.5;            ///< Set point of its oven in the publication.
};
inline constexpr TypicalUnit kTypicalUnit;

/// Normal prior of a parameter in its unit; of a lag, of the natural logarithm of seconds.
struct ThermalPrior {
    double mean = 0.0;       ///< Mean; of a lag, ln of the median in s.
    double deviation = 0.0;  ///< Standard deviation, > 0; of a lag, ln of the factor.
};

/// Returns the prior for a survey day.  Slopes: the typical unit, with deviations of 60 % of the
/// values; lags: log-normal, factor 1.5.
///
/// A day alone does not determine all parameters, so its prior has means that are not 0.  The
/// priors of different parameters are independent.  Test: thermal_response_test.cpp, "priors of a
/// day are the typical unit, those of a record leave it open".
[[nodiscard]] ThermalPrior day_prior(ThermalTerm term);

/// Deviations in a long record.  Those of rA and rS are five and three times the value of the
/// typical unit, that of rF 2.7 times.  Reason: the record is to measure them.
inline constexpr double kRecordSlopeDeviation_mgal_per_degc = 60.0;
inline constexpr double kRecordFastDeviation_mgal_per_degc_per_h = 30.0;
/// Factor of the log-normal priors of the lags in a long record.
inline constexpr double kRecordLagFactor = 2.0;

/// Returns the prior for a long record: slopes 0 with the deviations above; lags log-normal with
/// the medians of the typical unit and the factor above.
///
/// The slopes have mean 0, so that an estimate far from 0 comes from the record and not from the
/// typical unit.
[[nodiscard]] ThermalPrior record_prior(ThermalTerm term);

/// Returns the response of a first-order lag to a series: tau y' = x - y.
///
/// Between samples x is the cubic through the four nearest ones, in the first and the last step a
/// straight line; y = x at the first sample (equilibrium).  The recursion is exact for this x.
///
/// A NaN makes all values from the one before it NaN.  If y was not in equilibrium at the first sample, its error
/// decreases with exp(-t / tau): begin the series several tau before the values are needed.
///
/// Cost: O(n), two allocations.
/// Accuracy: a ramp agrees with its exact response within 1e-13 of its values.  A sine of twelve
/// samples has its exact response within 0.002 of its amplitude; straight lines alone would be off
/// by 0.02 (thermal_response_test.cpp).
/// @param series  x (n), at constant rate.
/// @param tau_s   time constant of the lag, s, > 0; not checked.
/// @return y (n), in the unit of the series; empty for an empty series.
[[nodiscard]] std::vector<double> lagged(const TimeSeries<DegC>& series, double tau_s);

/// Returns lagged() of two lags, in 0.62 of the time of two calls: each sum waits for the one before.
[[nodiscard]] std::array<std::vector<double>, 2> lagged(const TimeSeries<DegC>& series,
                                                        const std::array<double, 2>& tau_s);

/// Returns the rate that the fast path feels, (T - lag(T, tF)) / tF, degC/h (n).
///
/// It is 0 at the first sample.  For a steady ramp it becomes the slope after several tF.  NaN and
/// accuracy are those of lagged(): an error of lagged() counts by 3600 / tF.
/// @param series      T (n), at constant rate.
/// @param fast_lag_s  tF, s, > 0.
[[nodiscard]] std::vector<double> fast_rate_degc_per_h(const TimeSeries<DegC>& series,
                                                       double fast_lag_s);

/// The response with all parameters known.  A default-constructed one has no effect.
struct ThermalEffect {
    double level = 0.0, slow = 0.0, fast = 0.0;  ///< rA, rS, rF; 0: no such effect.
    double fast_lag_s = kTypicalUnit.fast_lag_s, slow_lag_s = kTypicalUnit.slow_lag_s;  ///< > 0.

    /// Returns the effect on the reading (n), mGal; it is added to the reading.
    ///
    /// To correct a reading, subtract it.  NaN is treated as by lagged().  The units of the slopes
    /// are those of ThermalTerm.
    /// @param series     T (n), at constant rate.
    /// @param zero_degc  T0: the temperature without effect.
    [[nodiscard]] std::vector<double> of(const TimeSeries<DegC>& series, double zero_degc) const;

    /// Returns the complex response at a period, mGal/degC:
    /// H = rA + rS / (1 + i w tS) + rF i w / (1 + i w tF), with w = 2 pi / period.
    ///
    /// Its phase is positive if the reading leads the temperature.  Very long periods give rA + rS,
    /// very short ones rA + 3600 rF / tF.
    /// Accuracy: amplitude and phase of of() for a sine agree within 1e-5
    /// (thermal_response_test.cpp).
    /// @param period_s  s, > 0.
    [[nodiscard]] std::complex<double> at(double period_s) const;
};

}  // namespace a351::unit
