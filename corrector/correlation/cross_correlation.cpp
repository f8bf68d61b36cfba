#include "corrector/correlation/cross_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "corrector/correlation/regression.hpp"

namespace a351::corrector {
namespace {

/// Returns the correlation at a lag, over the samples that overlap.
double correlation(std::span<const double> temperature, std::span<const double> acceleration,
                   int lag) {
    const auto shift = static_cast<std::size_t>(std::abs(lag));
    const std::size_t count = temperature.size() - shift;
    const auto x = lag >= 0 ? temperature.first(count) : temperature.subspan(shift);
    const auto y = lag >= 0 ? acceleration.subspan(shift) : acceleration.first(count);
    const double mean_x = mean_of(x), mean_y = mean_of(y);
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double dx = x[i] - mean_x, dy = y[i] - mean_y;
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
    }
    return xy / std::sqrt(xx * yy);
}

/// Returns the strongest correlation of a sign (1 or -1) among the middle half of the lags.
CorrelationPeak find_peak(const CrossCorrelation& all, double sign, double step_s) {
    const std::size_t half_cycle = (all.values.size() - 1) / 4;
    std::size_t best = half_cycle;
    for (std::size_t i = half_cycle; i <= 3 * half_cycle; ++i)
        if (sign * all.values[i] > sign * all.values[best]) best = i;
    const double before = all.values[best - 1], here = all.values[best],
                 after = all.values[best + 1];
    // Top of the parabola through three values: shift (b - a) / (2 (b - 2 h + a)), |shift| <= 1.
    const double bend = before - 2.0 * here + after;
    const double shift = bend != 0.0 ? std::clamp(0.5 * (before - after) / bend, -1.0, 1.0) : 0.0;
    return {all.delays_s[best] + step_s * shift, here - 0.25 * (before - after) * shift};
}

}  // namespace

CrossCorrelation correlate(std::span<const double> temperature,
                           std::span<const double> acceleration, int half_cycle, double step_s) {
    CrossCorrelation all;
    for (int lag = -2 * half_cycle; lag <= 2 * half_cycle; ++lag) {
        all.delays_s.push_back(step_s * lag);
        all.values.push_back(correlation(temperature, acceleration, lag));
    }
    all.negative = find_peak(all, -1.0, step_s);
    all.positive = find_peak(all, 1.0, step_s);
    return all;
}

}  // namespace a351::corrector
