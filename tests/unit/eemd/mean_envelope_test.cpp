#include "corrector/eemd/mean_envelope.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include "tests/support/catch.hpp"

#include "corrector/eemd/sift_kernels.hpp"
#include "tests/unit/eemd/series.hpp"

namespace a351::corrector::eemd {
namespace {

/// Alternating knots at irregular distances, among them half-integers and a gap of thousands.
const std::vector<double> kKnots = {0,      0,    1,    2,      3.5,  5,      9.5,  11,
                                    14,     15,   16,   4014.5, 4017, 4020,   4021, 4025,
                                    4026.5, 4029, 4033, 4034,   4035, 4035.5, 4040, 4040};

/// The mean of both splines, computed from the cubics of fit_mean_envelope().
class Mean {
public:
    Mean(const std::vector<double>& x, std::vector<double> y) : x_(x), envelope_(x.size()) {
        std::vector<double> with_room = x;
        with_room.resize(x.size() + 8);
        y.resize(x.size() + 8);
        fastest_kernels().fit_mean_envelope(with_room.data(), y.data(), x.size(),
                                            envelope_.arrays());
    }
    [[nodiscard]] double operator()(double t) const {
        std::size_t k = 1;
        while (k + 3 < x_.size() && x_[k + 1] <= t) ++k;
        const SplineArrays& a = envelope_.arrays();
        const double d = t - x_[k];
        return a.mean_y[k] + d * (a.mean_b[k] + d * (a.mean_c[k] + d * a.mean_e[k]));
    }

private:
    std::vector<double> x_;
    MeanEnvelope envelope_;
};

/// Returns every second element, beginning at `first`.
std::vector<double> lane(const std::vector<double>& all, std::size_t first) {
    std::vector<double> out;
    for (std::size_t k = first; k < all.size(); k += 2) out.push_back(all[k]);
    return out;
}

/// A spline from one dense system of its conditions. The unknowns are b, c, e of all segments'
/// cubics y + b d + c d^2 + e d^3.
class DenseSpline {
public:
    DenseSpline(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)) {
        const auto segments = static_cast<Eigen::Index>(x_.size()) - 1;
        Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3 * segments, 3 * segments);
        Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * segments);
        Eigen::Index row = 0;
        double h = 0.0;
        for (Eigen::Index i = 0; i < segments; ++i) {
            const auto k = static_cast<std::size_t>(i);
            h = x_[k + 1] - x_[k];
            a.block(row, 3 * i, 1, 3) << h, h * h, h * h * h;  // passes through the next knot
            right(row++) = y_[k + 1] - y_[k];
            if (i + 1 == segments) break;
            a.block(row, 3 * i, 1, 6) << 1, 2 * h, 3 * h * h, -1, 0, 0;  // slope
            a.block(row + 1, 3 * i, 1, 6) << 0, 1, 3 * h, 0, -1, 0;      // curvature
            row += 2;
        }
        a(row, 2) = 1;
        a(row++, 5) = -1;
        a(row, 3 * segments - 4) = 1;
        a(row, 3 * segments - 1) = -1;
        solution_ = a.fullPivLu().solve(right);
    }
    [[nodiscard]] double operator()(double t) const {
        std::size_t k = 0;
        while (k + 2 < x_.size() && x_[k + 1] <= t) ++k;
        const Eigen::Vector3d p = solution_.segment<3>(static_cast<Eigen::Index>(3 * k));
        const double d = t - x_[k];
        return y_[k] + d * (p[0] + d * (p[1] + d * p[2]));
    }

private:
    std::vector<double> x_, y_;
    Eigen::VectorXd solution_;
};

/// A spline through thousands of knots. Its curvatures (half the second derivatives) come from
/// plain elimination from the left and substitution from the right, with 64-bit mantissas.
class EliminatedSpline {
public:
    EliminatedSpline(std::vector<double> x, std::vector<double> y)
        : x_(std::move(x)), y_(std::move(y)), c_(x_.size()) {
        const std::size_t n = x_.size();
        std::vector<long double> diagonal(n, 1.0L), above(n), below(n), right(n);
        for (std::size_t k = 1; k + 1 < n; ++k) {
            below[k] = h(k - 1);
            diagonal[k] = 2.0L * (h(k - 1) + h(k));
            above[k] = h(k);
            right[k] = 3.0L * (slope(k) - slope(k - 1));
        }
        // The outermost curvatures are on the line through the next two.
        const long double left = h(0) / h(1);
        diagonal[1] += below[1] * (1.0L + left);
        above[1] -= below[1] * left;
        const long double last = h(n - 2) / h(n - 3);
        diagonal[n - 2] += above[n - 2] * (1.0L + last);
        below[n - 2] -= above[n - 2] * last;
        for (std::size_t k = 2; k + 1 < n; ++k) {
            const long double factor = below[k] / diagonal[k - 1];
            diagonal[k] -= factor * above[k - 1];
            right[k] -= factor * right[k - 1];
        }
        for (std::size_t k = n - 2; k >= 1; --k)
            c_[k] = (right[k] - (k + 2 < n ? above[k] * c_[k + 1] : 0.0L)) / diagonal[k];
        c_[0] = c_[1] + left * (c_[1] - c_[2]);
        c_[n - 1] = c_[n - 2] + last * (c_[n - 2] - c_[n - 3]);
    }
    [[nodiscard]] double operator()(double t) const {
        const auto after = std::upper_bound(x_.begin() + 1, x_.end() - 1, t);
        const auto k = static_cast<std::size_t>(after - x_.begin()) - 1;
        const auto d = static_cast<long double>(t - x_[k]);
        const long double third = (c_[k + 1] - c_[k]) / (3.0L * h(k));
        const long double first = slope(k) - h(k) * (c_[k + 1] + 2.0L * c_[k]) / 3.0L;
        return static_cast<double>(static_cast<long double>(y_[k]) +
                                   d * (first + d * (c_[k] + d * third)));
    }

private:
    [[nodiscard]] long double h(std::size_t k) const {
        return static_cast<long double>(x_[k + 1] - x_[k]);
    }
    [[nodiscard]] long double slope(std::size_t k) const {
        return static_cast<long double>(y_[k + 1] - y_[k]) / h(k);
    }

    std::vector<double> x_, y_;
    std::vector<long double> c_;
};

double cubic(double t) { return 2.0 + t * (-3.0 + t * (0.5 - 0.125 * t)); }

/// Requires the mean of both splines between all knots but the outermost.
template <class Spline>
void require_mean_of(const Spline& even, const Spline& odd, const Mean& mean,
                     const std::vector<double>& x, double margin) {
    for (std::size_t k = 1; k + 2 < x.size(); ++k) {
        const double t = x[k] + 0.375 * (x[k + 1] - x[k]);
        INFO(x.size() << " knots, t = " << t);
        REQUIRE(mean(t) == Approx(0.5 * (even(t) + odd(t))).epsilon(1e-9).margin(margin));
    }
}

}  // namespace

TEST_CASE("splines through samples of two cubics have the mean of the cubics") {
    for (std::size_t count = 8; count <= 11; ++count) {
        const std::vector<double> x(kKnots.begin(), kKnots.begin() + static_cast<long>(count));
        std::vector<double> y;
        for (std::size_t k = 0; k < count; ++k) y.push_back(k % 2 == 0 ? cubic(x[k]) : -3.0 * x[k]);
        const Mean mean(x, y);
        for (double t = 0.0; t <= x[count - 2]; t += 0.25)
            CHECK(mean(t) == Approx(0.5 * (cubic(t) - 3.0 * t)).epsilon(1e-12).margin(1e-12));
    }
}

TEST_CASE("envelopes with two to four knots are the polynomials through the knots") {
    // Even knots: 1 + t^2; odd ones: t^3, as far as their number determines them.
    const std::vector<double> x = {0, 0, 2, 3, 5, 7, 9, 9};
    const auto at = [](std::size_t k, double t) { return k % 2 == 0 ? 1 + t * t : t * t * t; };
    const auto polynomial = [&](std::size_t first, std::size_t n, double t) {
        double sum = 0.0;
        for (std::size_t i = first; i < n; i += 2) {
            double weight = 1.0;
            for (std::size_t j = first; j < n; j += 2)
                if (j != i) weight *= (t - x[j]) / (x[i] - x[j]);
            sum += weight * at(i, x[i]);
        }
        return sum;
    };
    for (std::size_t n = 4; n <= 8; ++n) {
        const std::vector<double> knots(x.begin(), x.begin() + static_cast<long>(n));
        std::vector<double> y;
        for (std::size_t k = 0; k < n; ++k) y.push_back(at(k, x[k]));
        const Mean mean(knots, y);
        for (double t = 0.0; t <= x[n - 2]; t += 0.5)
            CHECK(mean(t) == Approx(0.5 * (polynomial(0, n, t) + polynomial(1, n, t))));
    }
}

TEST_CASE("the mean envelope agrees with dense solutions of both splines") {
    // An envelope of three knots has no two segments left for the conditions at its ends.
    for (std::size_t count = 8; count <= kKnots.size(); ++count) {
        const std::vector<double> x(kKnots.begin(), kKnots.begin() + static_cast<long>(count));
        const std::vector<double> y = white_noise(count, 3);
        const DenseSpline even(lane(x, 0), lane(y, 0));
        const DenseSpline odd(lane(x, 1), lane(y, 1));
        const Mean mean(x, y);
        require_mean_of(even, odd, mean, x, 1e-10);
    }
}

TEST_CASE("thousands of knots are eliminated without overflow, to the same accuracy") {
    // Many blocks of the loops; distances of 1 to 7, and of 1 to 6e5 in the second half.
    std::vector<double> x = {0.0, 0.0};
    for (std::size_t k = 0; k < 5000; ++k)
        x.push_back(x.back() + 1.0 + static_cast<double>((k * k) % 7) * (k > 2500 ? 1e5 : 1.0));
    x.push_back(x.back());
    for (const std::size_t count : {4999U, 5000U, 5001U, 5003U}) {
        const std::vector<double> knots(x.end() - static_cast<long>(count), x.end());
        const std::vector<double> y = white_noise(count, 4);
        const EliminatedSpline even(lane(knots, 0), lane(y, 0));
        const EliminatedSpline odd(lane(knots, 1), lane(y, 1));
        const Mean mean(knots, y);
        // The limits are relative to the cubics' terms, which are as large as the splines' swings
        // between knots.
        require_mean_of(even, odd, mean, knots, 1e-9);
    }
}

}  // namespace a351::corrector::eemd
