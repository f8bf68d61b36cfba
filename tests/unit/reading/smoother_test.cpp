#include "corrector/reading/smoother.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include "tests/support/catch.hpp"
#include "tests/support/white_noise.hpp"

using namespace a351::corrector::eemd;

namespace a351::corrector::reading {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> white_noise(std::uint64_t member, std::size_t n) {
    std::vector<double> noise(n);
    fill_white_noise(31, member, noise);
    return noise;
}

std::vector<double> sine(std::size_t n, double period) {
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i)
        values[i] = std::sin(2.0 * std::numbers::pi * static_cast<double>(i) / period);
    return values;
}

/// Full matrix W + lambda D' D of PenalisedFit, with 64-bit mantissas.
using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

Matrix dense(const std::vector<double>& weights, double penalty) {
    const auto n = static_cast<Eigen::Index>(weights.size());
    Matrix differences = Matrix::Zero(n - 2, n);
    for (Eigen::Index i = 0; i + 2 < n; ++i) {
        differences(i, i) = 1.0L;
        differences(i, i + 1) = -2.0L;
        differences(i, i + 2) = 1.0L;
    }
    Matrix a = static_cast<long double>(penalty) * differences.transpose() * differences;
    for (Eigen::Index i = 0; i < n; ++i)
        a(i, i) += static_cast<long double>(weights[static_cast<std::size_t>(i)]);
    return a;
}

/// Returns a curve of the smoother's model: white second differences of variance 1 / penalty.
std::vector<double> random_curve(std::uint64_t member, std::size_t n, double penalty) {
    std::vector<double> curve = white_noise(member, n);
    double slope = 0.0;
    double value = 0.0;
    for (double& step : curve) {
        slope += step / std::sqrt(penalty);
        value += slope;
        step = value;
    }
    return curve;
}

}  // namespace

TEST_CASE("the banded fit and its inverse agree with a dense solution") {
    const double cutoff = GENERATE(2.0, 7.5, 30.0, 100.0);
    std::vector<double> weights = white_noise(1, 120);
    for (double& weight : weights) weight = std::abs(weight) < 0.3 ? 0.0 : std::abs(weight);
    const std::vector<double> right = white_noise(2, 120);
    const PenalisedFit fit(weights, penalty_of(cutoff));
    const Matrix inverse = dense(weights, penalty_of(cutoff)).inverse();
    const Eigen::Matrix<long double, Eigen::Dynamic, 1> expected =
        inverse * Eigen::Map<const Eigen::VectorXd>(right.data(), 120).cast<long double>();
    const std::vector<double> solved = fit.solve(right);
    const std::vector<double> diagonal = fit.inverse_diagonal();
    CAPTURE(cutoff);
    for (std::size_t i = 0; i < 120; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        REQUIRE(solved[i] == Approx(static_cast<double>(expected(row))).margin(1e-10).epsilon(0));
        REQUIRE(diagonal[i] ==
                Approx(static_cast<double>(inverse(row, row))).epsilon(0).margin(1e-10));
    }
}

TEST_CASE("with a long cut-off the solution is more accurate than its factors alone") {
    // The factors alone leave an error of 1e-6; the dense solution with 64-bit mantissas is
    // accurate to 1e-9.
    const std::vector<double> weights(200, 1.0);
    const std::vector<double> right = white_noise(5, 200);
    const Eigen::Matrix<long double, Eigen::Dynamic, 1> expected =
        dense(weights, penalty_of(1000.0))
            .ldlt()
            .solve(Eigen::Map<const Eigen::VectorXd>(right.data(), 200).cast<long double>());
    const std::vector<double> solved = PenalisedFit(weights, penalty_of(1000.0)).solve(right);
    const auto largest = static_cast<double>(expected.cwiseAbs().maxCoeff());
    for (std::size_t i = 0; i < 200; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        REQUIRE(std::abs(solved[i] - static_cast<double>(expected(row))) < 1e-8 * largest);
    }
}

TEST_CASE("a sine of the cut-off period is smoothed to half its height") {
    const double period = GENERATE(4.0, 10.0, 60.0, 150.0);
    const std::vector<double> series = sine(3000, period);  // end effects reach 10 periods
    const SmoothTrend trend = smooth(series, period);
    CAPTURE(period);
    for (std::size_t i = 1400; i < 1600; ++i)
        REQUIRE(trend.curve[i] == Approx(0.5 * series[i]).margin(1e-9));
    const double slow_gain = 1.0 / (1.0 + std::pow(std::sin(std::numbers::pi / (4.0 * period)) /
                                                       std::sin(std::numbers::pi / period),
                                                   4.0));
    const std::vector<double> slow = sine(3000, 4.0 * period);
    const SmoothTrend slow_trend = smooth(slow, period);
    for (std::size_t i = 1400; i < 1600; ++i)
        REQUIRE(slow_trend.curve[i] == Approx(slow_gain * slow[i]).margin(1e-9));
}

TEST_CASE("a straight line at a full gravity level is unchanged, even with gaps") {
    std::vector<double> line(500);
    for (std::size_t i = 0; i < line.size(); ++i)
        line[i] = 979'800.0 + 0.01 * static_cast<double>(i);
    std::vector<double> gaps = line;
    for (const std::size_t i : {0U, 1U, 200U, 201U, 202U, 203U, 499U}) gaps[i] = kNan;
    gaps[300] = std::numeric_limits<double>::infinity();
    const SmoothTrend trend = smooth(gaps, 100.0);
    for (std::size_t i = 0; i < line.size(); ++i)
        REQUIRE(trend.curve[i] == Approx(line[i]).margin(1e-8).epsilon(0));
    CHECK(trend.degrees_of_freedom > 2.0);
    CHECK(trend.degrees_of_freedom < 20.0);
}

TEST_CASE("a gap is bridged by the cubic of least bending, with larger standard errors") {
    std::vector<double> series = sine(600, 400.0);
    const auto noise = white_noise(3, 600);
    for (std::size_t i = 0; i < 600; ++i) series[i] += 0.05 * noise[i];
    std::vector<double> gap = series;
    std::fill(gap.begin() + 250, gap.begin() + 350, kNan);
    const SmoothTrend trend = smooth(gap, 150.0);
    for (std::size_t i = 252; i + 2 < 348; ++i) {
        const auto& z = trend.curve;
        const double fourth = z[i - 2] - 4.0 * z[i - 1] + 6.0 * z[i] - 4.0 * z[i + 1] + z[i + 2];
        REQUIRE(std::abs(fourth) < 1e-12);
    }
    const auto errors = trend.standard_errors();
    CHECK(errors[300] > 2.0 * errors[100]);
    CHECK(trend.weights[300] == 0.0);
}

TEST_CASE("Gaussian noise is fitted as by least squares, and outliers are left out") {
    std::vector<double> series = sine(600, 400.0);
    const auto noise = white_noise(4, 600);
    for (std::size_t i = 0; i < 600; ++i) series[i] += 0.1 * noise[i];
    const SmoothTrend clean = smooth(series, 150.0);
    CHECK(clean.noise_level == Approx(0.1).epsilon(0.1));
    CHECK(std::count_if(clean.weights.begin(), clean.weights.end(),
                        [](double weight) { return weight < 1.0; }) <= 6);

    std::vector<double> struck = series;
    for (const std::size_t i : {3U, 100U, 300U, 301U, 302U, 303U, 304U, 450U}) struck[i] += 50.0;
    const SmoothTrend robust = smooth(struck, 150.0);
    CHECK(robust.weights[302] == 0.0);
    double squares = 0.0;
    for (std::size_t i = 0; i < 600; ++i)
        squares += (robust.curve[i] - clean.curve[i]) * (robust.curve[i] - clean.curve[i]) / 600.0;
    CHECK(std::sqrt(squares) < 0.1 * clean.noise_level);
    CHECK(robust.noise_level == Approx(clean.noise_level).epsilon(0.03));
}

TEST_CASE("the stated standard errors cover the true errors as often as they should") {
    // Records of the model with a gap; of each record four points far from one another.
    const double penalty = penalty_of(60.0);
    std::size_t within_one = 0;
    std::size_t within_two = 0;
    std::size_t points = 0;
    double mean_squares = 0.0;
    double noise_variance = 0.0;
    constexpr std::size_t kRecords = 1000;
    for (std::uint64_t record = 0; record < kRecords; ++record) {
        const auto truth = random_curve(2 * record, 400, penalty);
        auto series = white_noise(2 * record + 1, 400);
        for (std::size_t i = 0; i < 400; ++i) series[i] += truth[i];
        std::fill(series.begin() + 180, series.begin() + 220, kNan);
        const SmoothTrend trend = smooth(series, 60.0);
        const auto errors = trend.standard_errors();
        for (const std::size_t i : {0U, 100U, 200U, 300U}) {
            const double share = std::abs(trend.curve[i] - truth[i]) / errors[i];
            within_one += share <= 1.0 ? 1 : 0;
            within_two += share <= 2.0 ? 1 : 0;
            ++points;
        }
        double error = 0.0;
        for (std::size_t i = 50; i <= 349; ++i) error += (trend.curve[i] - truth[i]) / 300.0;
        const double share = error / trend.standard_error_of_mean(50, 349);
        mean_squares += share * share / static_cast<double>(kRecords);
        noise_variance += trend.noise_level * trend.noise_level / static_cast<double>(kRecords);
    }
    // Gaussian: 0.683 and 0.954. With 4000 points these shares scatter by 0.007 and 0.003 (one
    // sigma).
    const double one = static_cast<double>(within_one) / static_cast<double>(points);
    const double two = static_cast<double>(within_two) / static_cast<double>(points);
    INFO(one << " " << two << " " << mean_squares);
    CHECK(one == Approx(0.683).margin(0.022));
    CHECK(two == Approx(0.954).margin(0.01));
    // Without the degrees of freedom of the curve it would be 0.96.
    CHECK(noise_variance == Approx(1.0).margin(0.012));
    CHECK(mean_squares == Approx(1.0).margin(0.13));  // 3 sigma of a mean of 1000 squares
}

TEST_CASE("rounding errors in a clean series are not taken for outliers") {
    std::vector<double> series(450);
    for (std::size_t i = 0; i < 450; ++i) series[i] = 979'800.0 + 0.01 * static_cast<double>(i);
    CHECK(smooth(series, 150.0).weights == std::vector<double>(450, 1.0));
    CHECK(smooth(series, 150.0).noise_level < 1e-8);
    const SmoothTrend three = smooth(std::vector<double>{0.0, 0.1, 0.2}, 2.0);
    CHECK(three.weights == std::vector<double>(3, 1.0));
    CHECK(three.noise_level < 1e-15);  // false for NaN as well
    CHECK(three.curve[1] == Approx(0.1));
}

TEST_CASE("samples up to 1e150 are smoothed like others, larger ones are refused") {
    const std::vector<double> noise = white_noise(6, 100);
    const SmoothTrend plain = smooth(noise, 10.0);
    std::vector<double> large = noise;
    for (double& value : large) value *= 2e149;
    const SmoothTrend trend = smooth(large, 10.0);
    CHECK(trend.noise_level / 2e149 == Approx(plain.noise_level));
    for (std::size_t i = 0; i < 100; ++i)
        REQUIRE(trend.curve[i] / 2e149 == Approx(plain.curve[i]).margin(1e-12));
    large[50] = -1.2e150;
    CHECK_THROWS_AS(smooth(large, 10.0), std::invalid_argument);
    large[50] = 1.2e308;
    CHECK_THROWS_AS(smooth(large, 10.0), std::invalid_argument);
}

TEST_CASE("weights that would alternate converge, and the result says if they do not") {
    // Blocks of a tenth of the record, five deviations high, put many samples on the weights'
    // flanks. With plain iteration 13 of these 400 records would not converge.
    std::size_t unsettled = 0;
    for (std::uint64_t record = 0; record < 400; ++record) {
        const std::size_t n = 40 + record;
        std::vector<double> series = white_noise(100 + record, n);
        const std::size_t begin = record * 37 % (n - n / 10);
        for (std::size_t i = begin; i < begin + n / 10; ++i) series[i] += 5.0;
        const double cutoff = 10.0 + static_cast<double>(record * 7 % 240);
        unsettled += smooth(series, cutoff).converged ? 0U : 1U;
    }
    CHECK(unsettled <= 3);
    const std::vector<double> three_apart = {57, 50, 60, 1, 11, 5, 5, 2, 6, 9, 7, 4};
    CHECK_FALSE(smooth(three_apart, 10.0).converged);
}

TEST_CASE("an unusable period or number of samples is refused") {
    const std::vector<double> series(10, 1.0);
    for (const double period : {1.9, 5001.0, kNan})
        CHECK_THROWS_AS(smooth(series, period), std::invalid_argument);
    CHECK_THROWS_AS(smooth(std::vector<double>{1.0, 2.0, kNan, kNan}, 5.0), std::invalid_argument);
    CHECK(smooth(std::vector<double>{1.0, kNan, 2.0, 3.0}, 5.0).curve.size() == 4);
    // Three samples at one end of 5000: rounding ruins a stiff curve before the other end.
    std::vector<double> far(5000, kNan);
    for (std::size_t i = 0; i < 3; ++i) far[i] = static_cast<double>(i % 2);
    CHECK_THROWS_AS(smooth(far, 200.0), std::invalid_argument);
    CHECK_THROWS_AS(smooth(far, 5000.0), std::invalid_argument);
    far.resize(20);
    CHECK(smooth(far, 10.0).degrees_of_freedom > 2.0);
    far.resize(3);
    CHECK(smooth(far, 5000.0).degrees_of_freedom == Approx(2.0).epsilon(0.001));
    // Three samples far apart: the curve passes through all of them with residuals below 1e-6.
    std::vector<double> apart(161, kNan);
    for (const std::size_t i : {0U, 80U, 160U}) apart[i] = static_cast<double>(i % 3);
    CHECK_THROWS_WITH(smooth(apart, 2.0), ContainsSubstring("passes through all its samples"));
    CHECK_THROWS_AS(PenalisedFit(std::vector<double>{0.0, 1.0, 0.0, 0.0}, 1.0),
                    std::invalid_argument);
}

}  // namespace a351::corrector::reading
