#include "corrector/whole_day/day_problem.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "corrector/whole_day/search_grid.hpp"
#include "protocol/linear_algebra/cholesky.hpp"
#include "protocol/linear_algebra/normal_matrix.hpp"
#include "protocol/signal/median.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

// fit_day() lists the priors; corrector/methods.md gives their origin.
constexpr LogNormalPrior kFlickerPrior_mgal{kUsualNoise.flicker_mgal, 2.0};
constexpr double kWhiteFactor = 2.0;

/// Returns a robust scatter of the bins, mGal: 1.4826 median |difference of neighbours| / sqrt(2),
/// at least 1e-3.  It is the median of the white noise's prior.
double bin_scatter_mgal(const std::vector<reading::DayBin>& bins) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < bins.size(); ++i)
        if (bins[i].set_up == bins[i - 1].set_up)
            steps.push_back(std::abs((bins[i].reading - bins[i - 1].reading).value()));
    if (steps.empty()) return 1.0;
    return std::max(signal::kGaussianPerMad * signal::median(std::move(steps)) / std::sqrt(2.0),
                    1e-3);
}

}  // namespace

DayProblem::DayProblem(const reading::DayRecord& record, const std::vector<DayStation>& stations,
                       const DayPriors& priors, const std::vector<double>& rough_mgal)
    : DayRegression(record, stations, priors, rough_mgal),
      whitening_(record.bins),
      white_mgal_{bin_scatter_mgal(record.bins), kWhiteFactor} {}

DayNoise DayProblem::noise(const Point& u) const {
    return {priors().placement_mgal.at(u[kPlacement]), kFlickerPrior_mgal.at(u[kFlicker]),
            white_mgal_.at(u[kWhite])};
}

DayProblem::Point DayProblem::point_of(const DayNoise& noise) const {
    Point u{};
    u[kPlacement] = priors().placement_mgal.place_of(noise.placement_mgal);
    u[kFlicker] = kFlickerPrior_mgal.place_of(noise.flicker_mgal);
    u[kWhite] = white_mgal_.place_of(noise.white_mgal);
    return u;
}

double DayProblem::cost(const Point& u, Eigen::MatrixXd columns) const {
    const double log_determinant = whitening_.whiten(noise(u), columns);
    const auto y = columns.col(0);
    const auto x = columns.rightCols(estimated());
    const linear_algebra::Cholesky factor(linear_algebra::normal_matrix(x));
    if (!factor.is_positive_definite()) return HUGE_VAL;  // overflow, far from the priors
    const Eigen::VectorXd half = factor.half_solve(x.transpose() * y);
    // 2 cost = ln det C + ln det(X'C^-1 X + 1) + y'C^-1 y - |L^-1 X'C^-1 y|^2 + |u|^2,
    // with L L' = X'C^-1 X + 1
    double sum = log_determinant + factor.log_determinant() + y.squaredNorm() - half.squaredNorm();
    for (const double value : u) sum += value * value;
    return 0.5 * sum;
}

DayProblem::Point DayProblem::most_likely(const std::optional<Point>& nearby) const {
    Point start = nearby.value_or(Point{});
    // From small biases the search may end where large ones are taken for a placement of 30 mGal.
    for (const double bias_size : {2.0, 4.0}) {
        Point other{};
        other[kBiasSize] = bias_size;
        if (!nearby && cost(other) < cost(start)) start = other;
    }
    LagColumns lagged;
    return least_cost_point(
        [&](const Point& u) { return cost(u, scaled(u, lagged)); }, start, nearby.has_value(),
        {.farthest = 12.0, .first_step = 0.5, .tolerance = 1e-3, .most_costs = 2000}, searched());
}

DayProblem::Point DayProblem::expected(const Point& u) const {
    constexpr double kStep = 0.25;
    const double least = cost(u);
    Point expected = u;
    const auto grow = [&](DayHyper place) {
        Point more = u, less = u;
        more.at(place) += kStep;
        less.at(place) -= kStep;
        const double curvature = (cost(more) - 2.0 * least + cost(less)) / (kStep * kStep);
        // x = median factor^u.  If ln x is normal with the mean m and the variance v, the root of
        // the mean square of x is exp(m + v), with v = (ln factor)^2 / curvature.
        expected.at(place) += log_factor(place) / std::max(curvature, 1.0);
    };
    grow(kPlacement);
    grow(kFlicker);
    grow(kBiasSize);
    if (has_outer()) grow(kOuterSize);
    return expected;
}

double DayProblem::log_factor(DayHyper part) const {
    switch (part) {
        case kPlacement:
            return std::log(priors().placement_mgal.factor);
        case kFlicker:
            return std::log(kFlickerPrior_mgal.factor);
        case kOuterSize:
            return std::log(kOuterSize_mgal_per_degc.factor);
        default:
            return std::log(priors().bias_factor);
    }
}

std::optional<std::array<double, 3>> DayProblem::noise_log_errors(const Point& u) const {
    constexpr double kStep = 0.25;
    constexpr std::array<DayHyper, 3> kParts{kPlacement, kFlicker, kWhite};
    const Eigen::MatrixXd columns = scaled(u);
    const auto moved = [&](std::size_t i, double by_i, std::size_t k, double by_k) {
        Point point = u;
        point.at(kParts.at(i)) += by_i;
        point.at(kParts.at(k)) += by_k;
        return cost(point, columns);
    };
    Eigen::Matrix3d curvature;
    for (std::size_t i = 0; i < kParts.size(); ++i)
        for (std::size_t k = 0; k <= i; ++k) {
            const double sum = moved(i, kStep, k, kStep) + moved(i, -kStep, k, -kStep) -
                               moved(i, kStep, k, -kStep) - moved(i, -kStep, k, kStep);
            curvature(static_cast<Index>(i), static_cast<Index>(k)) = sum / (4.0 * kStep * kStep);
            curvature(static_cast<Index>(k), static_cast<Index>(i)) = sum / (4.0 * kStep * kStep);
        }
    const linear_algebra::Cholesky factor(curvature);
    if (!factor.is_positive_definite()) return std::nullopt;
    const Eigen::MatrixXd covariance = factor.inverse();
    const std::array<double, 3> factors{priors().placement_mgal.factor, kFlickerPrior_mgal.factor,
                                        kWhiteFactor};
    std::array<double, 3> errors{};
    for (std::size_t i = 0; i < errors.size(); ++i)
        errors.at(i) = std::log(factors.at(i)) *
                       std::sqrt(covariance(static_cast<Index>(i), static_cast<Index>(i)));
    return errors;
}

Eigen::MatrixXd DayProblem::linearised(const Point& expected, const Eigen::VectorXd& values) const {
    Eigen::MatrixXd columns(readings_mgal().size(), estimated() + kLags);
    columns << scaled(expected).rightCols(estimated()), lag_columns(expected, values);
    whitening_.whiten(noise(expected), columns);
    return columns;
}

}  // namespace a351::corrector::whole_day
