#include "corrector/correlation/regression.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace a351::corrector {

double mean_of(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double variance_of(std::span<const double> values) {
    const double mean = mean_of(values);
    double sum = 0.0;
    for (const double value : values) sum += (value - mean) * (value - mean);
    return sum / static_cast<double>(values.size());
}

LineFit fit_line(std::span<const double> x, std::span<const double> y, std::size_t correlated) {
    LineFit fit;
    fit.count = x.size();
    fit.mean_x = mean_of(x);
    fit.mean_y = mean_of(y);
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double dx = x[i] - fit.mean_x, dy = y[i] - fit.mean_y;
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
    }
    fit.intercept = fit.mean_y;
    if (!(xx > 0.0)) return fit;
    fit.slope = xy / xx;
    fit.intercept = fit.mean_y - fit.slope * fit.mean_x;
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

}  // namespace a351::corrector
