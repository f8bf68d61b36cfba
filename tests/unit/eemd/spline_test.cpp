#include "corrector/eemd/spline.hpp"

#include <Eigen/Dense>
#include <array>
#include <catch2/catch.hpp>

#include "tests/unit/eemd/series.hpp"

namespace a351::corrector {
namespace {

/// Irregular knots, among them half-integers and a gap of thousands of samples.
const std::vector<double> kKnots = {0, 2, 3.5, 5, 9.5, 11, 14, 4014.5, 4017, 4020, 4021};

std::vector<double> noise_at(const std::vector<double>& knots) {
    return white_noise(knots.size(), 3);
}

/// The same spline from one dense system for (c, e) written down from the conditions themselves:
/// all cubics y + b d + c d^2 + e d^3 as unknowns b, c, e per segment.
Eigen::VectorXd dense_coefficients(const std::vector<double>& x, const std::vector<double>& y) {
    const auto segments = static_cast<Eigen::Index>(x.size()) - 1;
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3 * segments, 3 * segments);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * segments);
    Eigen::Index row = 0;
    for (Eigen::Index i = 0; i < segments; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double h = x[k + 1] - x[k];
        a.block(row, 3 * i, 1, 3) << h, h * h, h * h * h;  // passes through the next knot
        right(row++) = y[k + 1] - y[k];
        if (i + 1 == segments) break;
        a.block(row, 3 * i, 1, 6) << 1, 2 * h, 3 * h * h, -1, 0, 0;  // slope
        a.block(row + 1, 3 * i, 1, 6) << 0, 1, 3 * h, 0, -1, 0;      // curvature
        row += 2;
    }
    a(row, 2) = 1;
    a(row++, 5) = -1;
    a(row, 3 * segments - 4) = 1;
    a(row++, 3 * segments - 1) = -1;
    return a.fullPivLu().solve(right);
}

}  // namespace

TEST_CASE("a spline through samples of a cubic is that cubic") {
    const auto cubic = [](double t) { return 2.0 + t * (-3.0 + t * (0.5 - 0.125 * t)); };
    for (std::size_t count = 4; count <= 7; ++count) {
        const std::vector<double> x(kKnots.begin(), kKnots.begin() + static_cast<long>(count));
        std::vector<double> y;
        for (const double t : x) y.push_back(cubic(t));
        NotAKnotSpline spline(count);
        spline.fit(x, y);
        for (double t = 0.0; t <= x.back(); t += 0.25) {
            CHECK(spline.value(t) == Approx(cubic(t)).epsilon(1e-12).margin(1e-12));
        }
    }
}

TEST_CASE("two knots give the line and three the parabola") {
    NotAKnotSpline spline(3);
    const std::array<double, 3> x = {0.0, 2.0, 5.0};
    const std::array<double, 3> y = {1.0, 5.0, 26.0};  // 1 + t^2
    spline.fit(std::span(x).first(2), std::span(y).first(2));
    CHECK(spline.value(0.5) == Approx(2.0));
    spline.fit(x, y);
    for (double t = 0.0; t <= 5.0; t += 0.5) CHECK(spline.value(t) == Approx(1.0 + t * t));
}

TEST_CASE("slope and curvature are continuous at the knots, the outer third derivative too") {
    const std::vector<double> y = noise_at(kKnots);
    NotAKnotSpline spline(kKnots.size());
    spline.fit(kKnots, y);
    // Differences of a cubic over four points on one side of a knot are exact but for rounding.
    const auto derivatives = [&](double knot, double side) {
        const double s = 0.25 * side;
        std::array<double, 4> f{};
        for (int j = 0; j < 4; ++j)
            f[static_cast<std::size_t>(j)] = spline.value(knot + s * (j + 1e-9));
        const double third = (f[3] - 3 * f[2] + 3 * f[1] - f[0]) / (s * s * s);
        const double second = (f[2] - 2 * f[1] + f[0]) / (s * s) - third * s;
        const double first = (f[1] - f[0]) / s - second * s / 2 - third * s * s / 6;
        return std::array<double, 3>{first, second, third};
    };
    for (std::size_t i = 1; i + 1 < kKnots.size(); ++i) {
        INFO("knot " << i);
        const auto left = derivatives(kKnots[i], -1.0);
        const auto right = derivatives(kKnots[i], 1.0);
        CHECK(left[0] == Approx(right[0]).margin(1e-6));
        CHECK(left[1] == Approx(right[1]).margin(1e-6));
        if (i == 1 || i + 2 == kKnots.size()) CHECK(left[2] == Approx(right[2]).margin(1e-6));
    }
}

TEST_CASE("the spline agrees with a dense solution of its conditions") {
    for (std::size_t count = 4; count <= kKnots.size(); ++count) {
        const std::vector<double> x(kKnots.begin(), kKnots.begin() + static_cast<long>(count));
        const std::vector<double> y = noise_at(x);
        const Eigen::VectorXd dense = dense_coefficients(x, y);
        NotAKnotSpline spline(count);
        spline.fit(x, y);
        for (std::size_t i = 0; i + 1 < count; ++i) {
            const double d = 0.375 * (x[i + 1] - x[i]);
            const Eigen::Vector3d p = dense.segment<3>(static_cast<Eigen::Index>(3 * i));
            CHECK(spline.value(x[i] + d) ==
                  Approx(y[i] + d * (p[0] + d * (p[1] + d * p[2]))).epsilon(1e-9).margin(1e-10));
        }
    }
}

TEST_CASE("for_each_sample visits every sample once, with the value at it") {
    const std::vector<double> y = noise_at(kKnots);
    NotAKnotSpline spline(kKnots.size());
    spline.fit(kKnots, y);
    std::size_t expected = 0;
    spline.for_each_sample([&](std::size_t j, double value) {
        REQUIRE(j == expected++);
        REQUIRE(value == Approx(spline.value(static_cast<double>(j))).epsilon(1e-12).margin(1e-12));
    });
    CHECK(expected == 4022);
}

}  // namespace a351::corrector
