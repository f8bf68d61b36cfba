#include "protocol/signal/regression.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "protocol/signal/distributions.hpp"
#include "protocol/signal/moments.hpp"

namespace a351::signal {
namespace {

/// Sums of products of deviations from the means.
struct Products {
    double xx = 0.0, xy = 0.0, yy = 0.0;
};

Products products(std::span<const double> x, std::span<const double> y, double mean_x,
                  double mean_y) {
    Products sums;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double dx = x[i] - mean_x, dy = y[i] - mean_y;
        sums.xx += dx * dx;
        sums.xy += dx * dy;
        sums.yy += dy * dy;
    }
    return sums;
}

/// Returns the correlation at a lag, over the samples that overlap.
double correlation(std::span<const double> temperature, std::span<const double> acceleration,
                   int lag) {
    const auto shift = static_cast<std::size_t>(std::abs(lag));
    const std::size_t count = temperature.size() - shift;
    const auto x = lag >= 0 ? temperature.first(count) : temperature.subspan(shift);
    const auto y = lag >= 0 ? acceleration.subspan(shift) : acceleration.first(count);
    const auto [xx, xy, yy] = products(x, y, mean_of(x), mean_of(y));
    return xy / std::sqrt(xx * yy);
}

/// Returns the strongest correlation of a sign (1 or -1) within half a cycle of lag 0.
CorrelationPeak find_peak(const CrossCorrelation& all, double sign, std::size_t half_cycle,
                          double step_s) {
    const std::size_t middle = all.values.size() / 2;
    std::size_t best = middle - half_cycle;
    for (std::size_t i = best; i <= middle + half_cycle; ++i)
        if (sign * all.values[i] > sign * all.values[best]) best = i;
    const double before = all.values[best - 1], here = all.values[best],
                 after = all.values[best + 1];
    // Top of the parabola through three values: shift (b - a) / (2 (b - 2 h + a)), |shift| <= 1.
    const double bend = before - 2.0 * here + after;
    const double shift = bend != 0.0 ? std::clamp(0.5 * (before - after) / bend, -1.0, 1.0) : 0.0;
    return {all.delays_s[best] + step_s * shift, here - 0.25 * (before - after) * shift};
}

}  // namespace

LineFit fit_line(std::span<const double> x, std::span<const double> y, std::size_t correlated) {
    LineFit fit;
    fit.mean_x = mean_of(x);
    fit.mean_y = mean_of(y);
    const auto [xx, xy, yy] = products(x, y, fit.mean_x, fit.mean_y);
    if (!(xx > 0.0)) return fit;
    fit.slope = xy / xx;
    fit.r2 = yy > 0.0 ? xy * xy / (xx * yy) : 0.0;

    // Newey and West 1987: S = sum m_i^2 + 2 sum_l w_l sum_i m_i m_(i-l),  w_l = 1 - l / (L + 1)
    std::vector<double> moments(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double dx = x[i] - fit.mean_x;
        moments[i] = dx * (y[i] - fit.mean_y - fit.slope * dx);
    }
    double sum = 0.0;
    const std::size_t lags = std::min(correlated, x.size() - 1);
    for (std::size_t lag = 0; lag <= lags; ++lag) {
        double product = 0.0;
        for (std::size_t i = lag; i < moments.size(); ++i) product += moments[i] * moments[i - lag];
        const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(correlated + 1);
        sum += (lag == 0 ? 1.0 : 2.0 * weight) * product;
    }
    fit.slope_error = std::sqrt(std::max(sum, 0.0)) / xx;
    return fit;
}

std::vector<double> without_line(std::span<const double> values) {
    std::vector<double> numbers(values.size());
    std::iota(numbers.begin(), numbers.end(), 0.0);
    const LineFit line = fit_line(numbers, values);
    std::vector<double> rest(values.begin(), values.end());
    for (std::size_t i = 0; i < rest.size(); ++i)
        rest[i] -= line.mean_y + line.slope * (numbers[i] - line.mean_x);
    return rest;
}

CrossCorrelation correlate(std::span<const double> temperature,
                           std::span<const double> acceleration, int half_cycle, int most_lag,
                           double step_s) {
    CrossCorrelation all;
    for (int lag = -most_lag; lag <= most_lag; ++lag) {
        all.delays_s.push_back(step_s * lag);
        all.values.push_back(correlation(temperature, acceleration, lag));
    }
    const auto half = static_cast<std::size_t>(half_cycle);
    all.negative = find_peak(all, -1.0, half, step_s);
    all.positive = find_peak(all, 1.0, half, step_s);
    return all;
}

double chance_correlation(std::span<const double> x, std::span<const double> y, int most_lag) {
    const auto n = static_cast<double>(x.size());
    double sum = 1.0;
    for (int lag = 1; lag <= most_lag; ++lag)
        sum += 2.0 * (1.0 - lag / n) * correlation(x, x, lag) * correlation(y, y, lag);
    return std::min(1.0, kNormal95 * std::sqrt(std::max(sum, 1.0) / n));
}

}  // namespace a351::signal
