#include "protocol/unit/thermal_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "protocol/unit/calibration.hpp"

namespace a351::unit {

namespace {

constexpr double kDayLagFactor = 1.5;

ThermalPrior of_lag(double median_s, double factor) {
    return {std::log(median_s), std::log(factor)};
}

// Assumed: how much units differ is not known.
ThermalPrior within_60_percent(double mean) { return {mean, 0.6 * std::abs(mean)}; }

/// Returns w_j, the lag's output at the end of a step h = step / tau for the input s^j, 0 <= s <= 1,
/// j = 0 ... 3: w_j = 1 - j / h w_(j-1).
std::array<double, 4> powers_after_lag(double h) {
    std::array<double, 4> w{-std::expm1(-h)};
    if (h > 4.0) {  // upwards, errors shrink by j / h
        for (std::size_t j = 1; j < w.size(); ++j)
            w[j] = 1.0 - static_cast<double>(j) / h * w[j - 1];
        return w;
    }
    // Downwards from any w_30, errors shrink by h / j.
    double value = 0.0;
    for (std::size_t j = 30; j > 0; --j) {
        value = h / static_cast<double>(j) * (1.0 - value);
        if (j <= w.size()) w[j - 1] = value;
    }
    return w;
}

}  // namespace

ThermalPrior day_prior(ThermalTerm term) {
    static const std::array priors{within_60_percent(kTypicalUnit.level_mgal_per_degc),
                                   within_60_percent(kTypicalUnit.slow_mgal_per_degc),
                                   within_60_percent(kTypicalUnit.fast_mgal_per_degc_per_h),
                                   of_lag(kTypicalUnit.fast_lag_s, kDayLagFactor),
                                   of_lag(kTypicalUnit.slow_lag_s, kDayLagFactor)};
    static_assert(priors.size() == kThermalTerms);
    return priors.at(static_cast<std::size_t>(term));
}

ThermalPrior record_prior(ThermalTerm term) {
    static const std::array priors{ThermalPrior{0.0, kRecordSlopeDeviation_mgal_per_degc},
                                   ThermalPrior{0.0, kRecordSlopeDeviation_mgal_per_degc},
                                   ThermalPrior{0.0, kRecordFastDeviation_mgal_per_degc_per_h},
                                   of_lag(kTypicalUnit.fast_lag_s, kRecordLagFactor),
                                   of_lag(kTypicalUnit.slow_lag_s, kRecordLagFactor)};
    static_assert(priors.size() == kThermalTerms);
    return priors.at(static_cast<std::size_t>(term));
}

ThermalResponse record_priors() {
    ThermalResponse priors;
    for (std::size_t k = 0; k < kThermalTerms; ++k) {
        const ThermalPrior prior = record_prior(static_cast<ThermalTerm>(k));
        const auto place = static_cast<Eigen::Index>(k);
        priors.values(place) = prior.mean;
        priors.covariance(place, place) = prior.deviation * prior.deviation;
    }
    return priors;
}

std::array<std::vector<double>, 2> lagged(const TimeSeries<DegC>& series,
                                          const std::array<double, 2>& tau_s) {
    using Pair [[gnu::vector_size(2 * sizeof(double))]] = double;
    Pair keep = {}, w[4] = {};
    for (std::size_t lag = 0; lag < tau_s.size(); ++lag) {
        const double h = 1.0 / (series.rate().value() * tau_s.at(lag));
        const std::array<double, 4> powers = powers_after_lag(h);
        keep[lag] = std::exp(-h);
        for (std::size_t j = 0; j < powers.size(); ++j) w[j][lag] = powers.at(j);
    }
    const std::vector<double>& x = series.values();
    std::array<std::vector<double>, 2> behind{std::vector<double>(x.size()),
                                              std::vector<double>(x.size())};
    Pair y = {};
    for (std::size_t i = 0; i < x.size(); ++i) {
        // y_i = k y_(i-1) + w0 x_(i-1) + w1 a + w2 b + w3 c, where the temperature in the step is
        // x_(i-1) + a s + b s^2 + c s^3
        if (i == 0) {
            y += x[0];
        } else {
            const double from = x[i - 1], to = x[i];
            double a = to - from, b = 0.0, c = 0.0;
            if (i > 1 && i + 1 < x.size()) {  // Lagrange's cubic through four samples
                const double before = x[i - 2], after = x[i + 1];
                b = 0.5 * (before + to) - from;
                c = (after - before) / 6.0 + 0.5 * (from - to);
                a -= b + c;
            }
            // The input is summed first: only a product and a sum have to wait for the step before.
            const Pair input = w[0] * from + w[1] * a + w[2] * b + w[3] * c;
            y = keep * y + input;
        }
        behind[0][i] = y[0];
        behind[1][i] = y[1];
    }
    return behind;
}

std::vector<double> lagged(const TimeSeries<DegC>& series, double tau_s) {
    return std::move(lagged(series, std::array{tau_s, tau_s})[0]);
}

std::vector<double> fast_rate_degc_per_h(const TimeSeries<DegC>& series, double fast_lag_s) {
    std::vector<double> rate = lagged(series, fast_lag_s);
    for (std::size_t i = 0; i < rate.size(); ++i)
        rate[i] = (series.values()[i] - rate[i]) / fast_lag_s * kSecondsPerHour;
    return rate;
}

std::vector<double> ThermalEffect::of(const TimeSeries<DegC>& series, double zero_degc) const {
    const std::vector<double>& t = series.values();
    const auto [behind_fast, behind_slow] = lagged(series, std::array{fast_lag_s, slow_lag_s});
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
