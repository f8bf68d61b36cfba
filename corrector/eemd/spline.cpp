#include "corrector/eemd/spline.hpp"

#include <algorithm>

namespace a351::corrector {

NotAKnotSpline::NotAKnotSpline(std::size_t max_knots)
    : h_(max_knots),
      inverse_(max_knots),
      slope_(max_knots),
      upper_(max_knots),
      b_(max_knots),
      c_(max_knots),
      e_(max_knots) {}

void NotAKnotSpline::fit(std::span<const double> positions,
                         std::span<const double> values) noexcept {
    x_ = positions;
    y_ = values;
    const std::size_t n = x_.size() - 1;
    for (std::size_t i = 0; i < n; ++i) {
        h_[i] = x_[i + 1] - x_[i];
        inverse_[i] = 1.0 / h_[i];
        slope_[i] = (y_[i + 1] - y_[i]) / h_[i];
    }
    solve_curvatures();
    constexpr double kThird = 1.0 / 3.0;
    for (std::size_t i = 0; i < n; ++i) {
        b_[i] = slope_[i] - kThird * h_[i] * (c_[i + 1] + 2.0 * c_[i]);
        e_[i] = kThird * inverse_[i] * (c_[i + 1] - c_[i]);
    }
}

void NotAKnotSpline::solve_curvatures() noexcept {
    const std::size_t n = x_.size() - 1;
    if (n == 1) {
        c_[0] = c_[1] = 0.0;
        return;
    }
    if (n == 2) {
        c_[0] = c_[1] = c_[2] = (slope_[1] - slope_[0]) / (h_[0] + h_[1]);
        return;
    }
    // Diagonally dominant, so elimination needs no pivots.  c_ holds the right-hand sides first.
    double pivot = 1.0 / (h_[0] + 2.0 * h_[1]);
    upper_[1] = (h_[1] - h_[0]) * pivot;
    c_[1] = 3.0 * h_[1] / (h_[0] + h_[1]) * (slope_[1] - slope_[0]) * pivot;
    for (std::size_t i = 2; i + 1 < n; ++i) {
        pivot = 1.0 / (2.0 * (h_[i - 1] + h_[i]) - h_[i - 1] * upper_[i - 1]);
        upper_[i] = h_[i] * pivot;
        c_[i] = (3.0 * (slope_[i] - slope_[i - 1]) - h_[i - 1] * c_[i - 1]) * pivot;
    }
    const double left = h_[n - 2];
    const double right = h_[n - 1];
    const double lower = left - right;
    c_[n - 1] =
        (3.0 * left / (left + right) * (slope_[n - 1] - slope_[n - 2]) - lower * c_[n - 2]) /
        (2.0 * left + right - lower * upper_[n - 2]);
    for (std::size_t i = n - 2; i >= 1; --i) c_[i] -= upper_[i] * c_[i + 1];
    c_[0] = c_[1] + h_[0] * inverse_[1] * (c_[1] - c_[2]);
    c_[n] = c_[n - 1] + right * inverse_[n - 2] * (c_[n - 1] - c_[n - 2]);
}

double NotAKnotSpline::value(double t) const noexcept {
    const auto inner = x_.subspan(1, x_.size() - 2);
    const auto i =
        static_cast<std::size_t>(std::upper_bound(inner.begin(), inner.end(), t) - inner.begin());
    const double d = t - x_[i];
    return y_[i] + d * (b_[i] + d * (c_[i] + d * e_[i]));
}

}  // namespace a351::corrector
