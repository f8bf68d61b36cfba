#include "corrector/whole_day/station_system.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "corrector/whole_day/day_problem.hpp"
#include "protocol/linear_algebra/cholesky.hpp"
#include "protocol/linear_algebra/normal_matrix.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

/// Returns the gravities of a fit, in order of their numbers; `own` of one that is held is not set.
std::vector<StationGravity> gravities_of(const DayProblem& problem,
                                         const std::vector<DayStation>& stations,
                                         const DayFit& fit) {
    std::vector<StationGravity> gravities;
    for (const GravityEstimate& gravity : fit.gravity_mgal) {
        const Index place = problem.place_of(gravities.size());
        gravities.push_back({gravity.value, false, 0.0, place, place});
    }
    for (const DayStation& station : stations)
        if (station.gravity) {
            gravities[station.number].is_held = true;
            gravities[station.number].u_mgal = station.u_gravity.value();
        }
    return gravities;
}

/// Returns the system of a day.
StationSystem system_of_day(const reading::DayRecord& record,
                            const std::vector<DayStation>& stations, const DayFit& fit,
                            const DayPriors& priors) {
    const DayProblem problem(record, stations, priors);
    const DayNoise noise = problem.noise(fit.expected);
    const Index estimated = problem.estimated();
    // The residuals of least squares with the expected noise; the lags stay those of the fit.
    Eigen::MatrixXd scaled = problem.scaled(fit.expected);
    whiten(record.bins, noise, scaled);
    const auto x = scaled.rightCols(estimated);
    const Eigen::VectorXd solution = linear_algebra::Cholesky(linear_algebra::normal_matrix(x))
                                         .solve(x.transpose() * scaled.col(0));
    const Eigen::VectorXd left = scaled.col(0) - x * solution;
    const Eigen::VectorXd values = problem.unscaled(fit.expected, solution);
    const Eigen::MatrixXd fitted = problem.linearised(fit.expected, values);

    std::vector<StationGravity> gravities = gravities_of(problem, stations, fit);
    Index count = fitted.cols();
    for (StationGravity& gravity : gravities)
        if (gravity.is_held) gravity.own = count++;
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(fitted.rows(), count);
    for (Index i = 0; i < columns.rows(); ++i) {
        const std::size_t set_up = record.bins[static_cast<std::size_t>(i)].set_up;
        const StationGravity& gravity = gravities[stations[set_up].number];
        if (gravity.is_held) columns(i, gravity.own) = kFreeGravity_mgal;
    }
    whiten(record.bins, noise, columns);
    columns.leftCols(fitted.cols()) = fitted;
    Eigen::VectorXd gradient = columns.transpose() * left;
    // The fit is a minimum: only a column that it lacks can improve it.
    gradient.head(fitted.cols()).setZero();
    return {std::move(gravities), columns.transpose() * columns, std::move(gradient)};
}

}  // namespace

StationSystem::StationSystem(const reading::DayRecord& record,
                             const std::vector<DayStation>& stations, const DayFit& fit,
                             const DayPriors& priors)
    : StationSystem(system_of_day(record, stations, fit, priors)) {}

StationSystem::StationSystem(std::vector<StationGravity> gravities, Eigen::MatrixXd products,
                             Eigen::VectorXd gradient)
    : gravities_(std::move(gravities)),
      information_(std::move(products)),
      gradient_(std::move(gradient)) {
    information_.diagonal().array() += 1.0;
    for (Index k = 0; k < gradient_.size(); ++k) common_.push_back(k);
    for (const StationGravity& gravity : gravities_) {
        if (!gravity.is_held) continue;
        std::erase(common_, gravity.own);
        std::erase(common_, gravity.held);
    }
}

StationSystem::Combination StationSystem::solved(const std::vector<Index>& columns,
                                                 const Eigen::VectorXd& wanted) const {
    const Eigen::VectorXd s =
        linear_algebra::Cholesky(information_(columns, columns)).solve(wanted(columns));
    Combination result{s.dot(gradient_(columns)), Eigen::VectorXd::Zero(gradient_.size())};
    result.parts(columns) = s;
    return result;
}

Estimate StationSystem::difference(std::size_t from, std::size_t to) const {
    std::vector<Index> columns = common_;
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(gradient_.size());
    bool has_datum = false;
    for (std::size_t number = 0; number < gravities_.size(); ++number) {
        const StationGravity& gravity = gravities_[number];
        const bool is_hidden = number == from || number == to;
        if (is_hidden || !gravity.is_held) continue;
        has_datum = true;
        if (gravity.held >= 0) columns.push_back(gravity.held);
    }
    // Without another reference nothing gives the level, on which a difference does not depend.
    // `from` is then held, or `to` if `from` has no reference.
    const bool is_from_datum = !has_datum && gravities_[from].is_held;
    const bool is_to_datum = !has_datum && !is_from_datum;
    const auto add = [&](std::size_t number, bool is_datum, double factor) {
        const StationGravity& gravity = gravities_[number];
        if (is_datum) return;
        if (gravity.is_held) columns.push_back(gravity.own);
        wanted(gravity.own) = factor * kFreeGravity_mgal;
    };
    add(from, is_from_datum, -1.0);
    add(to, is_to_datum, 1.0);
    const Combination both = solved(columns, wanted);
    return {gravities_[to].fitted_mgal - gravities_[from].fitted_mgal + both.value_mgal,
            std::sqrt(variance_mgal2(both))};
}

StationSystem::Combination StationSystem::left_out_combination(std::size_t number) const {
    // Without its only reference the system has no datum.
    const bool is_hidden = gravities_[number].is_held &&
                           std::ranges::count(gravities_, true, &StationGravity::is_held) > 1;
    std::vector<Index> columns = common_;
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(gradient_.size());
    for (std::size_t other = 0; other < gravities_.size(); ++other) {
        const StationGravity& gravity = gravities_[other];
        const bool is_own = is_hidden && other == number;
        const Index column = is_own ? gravity.own : gravity.held;
        if (gravity.is_held && column >= 0) columns.push_back(column);
        if (other == number && column >= 0)
            wanted(column) = gravity.is_held && !is_own ? gravity.u_mgal : kFreeGravity_mgal;
    }
    return solved(columns, wanted);
}

Estimate StationSystem::left_out(std::size_t number) const {
    const Combination combination = left_out_combination(number);
    return {gravities_[number].fitted_mgal + combination.value_mgal,
            std::sqrt(variance_mgal2(combination))};
}

Eigen::MatrixXd StationSystem::correlation() const {
    Eigen::MatrixXd parts(gradient_.size(), std::ssize(gravities_));
    for (std::size_t number = 0; number < gravities_.size(); ++number) {
        const Combination combination = left_out_combination(number);
        const double u_mgal = std::sqrt(variance_mgal2(combination));
        parts.col(static_cast<Index>(number)) = combination.parts / (u_mgal > 0.0 ? u_mgal : 1.0);
    }
    return parts.transpose() * information_ * parts;
}

}  // namespace a351::corrector::whole_day
