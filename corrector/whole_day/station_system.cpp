#include "corrector/whole_day/station_system.hpp"

#include <algorithm>

#include "corrector/whole_day/day_problem.hpp"
#include "protocol/linear_algebra/cholesky.hpp"
#include "protocol/linear_algebra/normal_matrix.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

}  // namespace

StationSystem::StationSystem(const reading::DayRecord& record,
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

    for (Index k = 0; k < fitted.cols(); ++k) common_.push_back(k);
    Index count = fitted.cols();
    for (const GravityEstimate& gravity : fit.gravity_mgal) {
        const Index place = problem.place_of(gravities_.size());
        gravities_.push_back({gravity.value, false, 0.0, place, place});
    }
    for (const DayStation& station : stations)
        if (station.gravity) {
            gravities_[station.number].is_held = true;
            gravities_[station.number].u_mgal = station.u_gravity.value();
        }
    for (Gravity& gravity : gravities_) {
        if (!gravity.is_held) continue;
        gravity.own = count++;
        std::erase(common_, gravity.held);
    }
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(fitted.rows(), count - fitted.cols());
    for (Index i = 0; i < own.rows(); ++i) {
        const std::size_t set_up = record.bins[static_cast<std::size_t>(i)].set_up;
        const Index place = gravities_[stations[set_up].number].own - fitted.cols();
        if (place >= 0) own(i, place) = kFreeGravity_mgal;
    }
    whiten(record.bins, noise, own);
    columns_.resize(fitted.rows(), count);
    columns_ << fitted, own;
    gradient_ = columns_.transpose() * left;
    // The fit is a minimum: only a column that it lacks can improve it.
    gradient_.head(fitted.cols()).setZero();
}

StationSystem::Combination StationSystem::solved(const std::vector<Index>& columns,
                                                 const Eigen::VectorXd& wanted) const {
    const Eigen::MatrixXd x = columns_(Eigen::all, columns);
    // The error of s'X'y is s'(X'e + p), with s = (X'X + 1)^-1 wanted.
    const Eigen::VectorXd s =
        linear_algebra::Cholesky(linear_algebra::normal_matrix(x)).solve(wanted(columns));
    Combination result{s.dot(gradient_(columns)),
                       Eigen::VectorXd::Zero(columns_.rows() + columns_.cols())};
    result.errors_mgal.head(columns_.rows()) = x * s;
    for (std::size_t k = 0; k < columns.size(); ++k)
        result.errors_mgal(columns_.rows() + columns[k]) = s(static_cast<Index>(k));
    return result;
}

Estimate StationSystem::difference(std::size_t from, std::size_t to) const {
    std::vector<Index> columns = common_;
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(columns_.cols());
    bool has_datum = false;
    for (std::size_t number = 0; number < gravities_.size(); ++number) {
        const Gravity& gravity = gravities_[number];
        const bool is_hidden = number == from || number == to;
        if (is_hidden || !gravity.is_held) continue;
        has_datum = true;
        if (gravity.held >= 0) columns.push_back(gravity.held);
    }
    // Without another reference one of both stations is the datum of their difference.
    const bool is_from_datum = !has_datum && gravities_[from].is_held;
    const bool is_to_datum = !has_datum && !is_from_datum;
    const auto add = [&](std::size_t number, bool is_datum, double factor) {
        const Gravity& gravity = gravities_[number];
        if (is_datum) return;
        if (gravity.is_held) columns.push_back(gravity.own);
        wanted(gravity.own) = factor * kFreeGravity_mgal;
    };
    add(from, is_from_datum, -1.0);
    add(to, is_to_datum, 1.0);
    const Combination both = solved(columns, wanted);
    return {gravities_[to].fitted_mgal - gravities_[from].fitted_mgal + both.value_mgal,
            both.errors_mgal.norm()};
}

Eigen::MatrixXd StationSystem::correlation() const {
    // Without its only reference the system has no datum.
    const bool are_hidden = std::ranges::count(gravities_, true, &Gravity::is_held) > 1;
    Eigen::MatrixXd errors(columns_.rows() + columns_.cols(), std::ssize(gravities_));
    for (std::size_t number = 0; number < gravities_.size(); ++number) {
        std::vector<Index> columns = common_;
        Eigen::VectorXd wanted = Eigen::VectorXd::Zero(columns_.cols());
        for (std::size_t other = 0; other < gravities_.size(); ++other) {
            const Gravity& gravity = gravities_[other];
            const bool is_own = gravity.is_held && are_hidden && other == number;
            const Index column = is_own ? gravity.own : gravity.held;
            if (gravity.is_held && column >= 0) columns.push_back(column);
            if (other == number && column >= 0)
                wanted(column) = gravity.is_held && !is_own ? gravity.u_mgal : kFreeGravity_mgal;
        }
        errors.col(static_cast<Index>(number)) = solved(columns, wanted).errors_mgal.normalized();
    }
    return errors.transpose() * errors;
}

}  // namespace a351::corrector::whole_day
