#pragma once
/// @file
/// Cubic spline with not-a-knot ends, refitted many times without allocating.

#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector {

/// Piecewise cubic through knots (X_i, Y_i), i = 0..n, twice continuously differentiable:
///
///     S(t) = Y_i + d (b_i + d (c_i + d e_i)),   d = t - X_i,   X_i <= t <= X_{i+1}
///
/// The third derivative is continuous at X_1 and X_{n-1} (not-a-knot).  Three knots give the
/// parabola, two the line.
///
/// Accuracy: cubics come back to rounding (spline_test.cpp).
/// Source: C. de Boor, A Practical Guide to Splines, Springer, 1978, chap. IV.  c_i here is half
/// the second derivative.
class NotAKnotSpline {
public:
    /// Room for up to `max_knots` knots.
    explicit NotAKnotSpline(std::size_t max_knots);

    /// Fits positions.size() >= 2 knots with strictly ascending positions; does not allocate.
    /// The spans must outlive the next call of value() or for_each_sample().
    void fit(std::span<const double> positions, std::span<const double> values) noexcept;

    /// S(t); beyond the ends the outer cubics continue.
    [[nodiscard]] double value(double t) const noexcept;

    /// Calls take(j, S(j)) for j = 0, 1, ... X_n.  Needs X_0 = 0 and X_n a whole number.
    template <class Take>
    void for_each_sample(Take take) const;

private:
    void solve_curvatures() noexcept;

    std::span<const double> x_;
    std::span<const double> y_;
    std::vector<double> h_;        ///< X_{i+1} - X_i
    std::vector<double> inverse_;  ///< 1 / h_i
    std::vector<double> slope_;    ///< (Y_{i+1} - Y_i) / h_i
    std::vector<double> upper_;    ///< Elimination: c_i = right_i - upper_i c_{i+1}
    std::vector<double> b_, c_, e_;
};

template <class Take>
void NotAKnotSpline::for_each_sample(Take take) const {
    std::size_t j = 0;
    const std::size_t segments = x_.size() - 1;
    for (std::size_t i = 0; i < segments; ++i) {
        const double origin = x_[i];
        const double y = y_[i];
        const double b = b_[i];
        const double c = c_[i];
        const double e = e_[i];
        // Samples up to X_{i+1}, which belongs to the next segment if it is a sample itself.
        const std::size_t end = static_cast<std::size_t>(x_[i + 1] + 0.5);
        for (; j < end; ++j) {
            const double d = static_cast<double>(j) - origin;
            take(j, y + d * (b + d * (c + d * e)));
        }
    }
    take(j, y_[segments]);
}

}  // namespace a351::corrector
