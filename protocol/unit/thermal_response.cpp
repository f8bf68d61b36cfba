#include "protocol/unit/thermal_response.hpp"

#include <numbers>

namespace a351::unit {

namespace {

constexpr double kDayLagFactor = 1.5;

/// Priors in the order of ThermalTerm.
using Priors = std::array<ThermalPrior, kThermalTerms>;

ThermalPrior of_lag(double median_s, double factor) {
    return {std::log(median_s), std::log(factor)};
}

// Assumed: how much units differ is not known.
ThermalPrior within_60_percent(double mean) { return {mean, 0.6 * std::abs(mean)}; }

}  // namespace

ThermalPrior day_prior(ThermalTerm term) {
    static const Priors priors{within_60_percent(kTypicalUnit.level_mgal_per_degc),
                               within_60_percent(kTypicalUnit.slow_mgal_per_degc),
                               within_60_percent(kTypicalUnit.fast_mgal_per_degc_per_h),
                               of_lag(kTypicalUnit.fast_lag_s, kDayLagFactor),
                               of_lag(kTypicalUnit.slow_lag_s, kDayLagFactor)};
    return priors.at(static_cast<std::size_t>(term));
}

ThermalPrior record_prior(ThermalTerm term) {
    static const Priors priors{ThermalPrior{0.0, kRecordSlopeDeviation_mgal_per_degc},
                               {0.0, kRecordSlopeDeviation_mgal_per_degc},
                               {0.0, kRecordFastDeviation_mgal_per_degc_per_h},
                               of_lag(kTypicalUnit.fast_lag_s, kRecordLagFactor),
                               of_lag(kTypicalUnit.slow_lag_s, kRecordLagFactor)};
    return priors.at(static_cast<std::size_t>(term));
}

std::vector<double> lagged(const TimeSeries<DegC>& series, double tau_s) {
    const double step = 1.0 / (series.rate().value() * tau_s);
    // Exact for straight lines between samples:
    // y_i = k y_(i-1) + (1 - k) x_(i-1) + (1 - (1 - k) / h) (x_i - x_(i-1))
    const double keep = std::exp(-step);
    const double of_rise = 1.0 - (1.0 - keep) / step;
    const std::vector<double>& x = series.values();
    std::vector<double> y = x;
    for (std::size_t i = 1; i < x.size(); ++i)
        y[i] = keep * y[i - 1] + (1.0 - keep) * x[i - 1] + of_rise * (x[i] - x[i - 1]);
    return y;
}

std::vector<double> fast_rate_degc_per_h(const TimeSeries<DegC>& series, double fast_lag_s) {
    std::vector<double> rate = lagged(series, fast_lag_s);
    for (std::size_t i = 0; i < rate.size(); ++i)
        rate[i] = (series.values()[i] - rate[i]) / fast_lag_s * kSecondsPerHour;
    return rate;
}

std::vector<double> ThermalEffect::of(const TimeSeries<DegC>& series, double zero_degc) const {
    const std::vector<double>& t = series.values();
    const std::vector<double> behind_fast = lagged(series, fast_lag_s),
                              behind_slow = lagged(series, slow_lag_s);
    std::vector<double> effect(t.size());
    // The fast rate is written out, because the order of rounding decides the last bits of results.
    for (std::size_t i = 0; i < t.size(); ++i)
        effect[i] = level * (t[i] - zero_degc) + slow * (behind_slow[i] - zero_degc) +
                    fast * kSecondsPerHour * (t[i] - behind_fast[i]) / fast_lag_s;
    return effect;
}

std::complex<double> ThermalEffect::at(double period_s) const {
    const std::complex<double> turn(0.0, 2.0 * std::numbers::pi / period_s);
    return level + slow / (1.0 + turn * slow_lag_s) +
           fast * kSecondsPerHour * turn / (1.0 + turn * fast_lag_s);
}

}  // namespace a351::unit
