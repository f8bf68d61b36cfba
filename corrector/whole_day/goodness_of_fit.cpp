#include "corrector/whole_day/goodness_of_fit.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "corrector/whole_day/day_problem.hpp"
#include "protocol/linear_algebra/cholesky.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

/// Number of simulated days.  Reason: a probability of 1 % has a standard error of 0.2 %.
constexpr int kDraws = 2000;

/// Returns the matrix (set-ups, bins) that averages bins over set-ups, weighted by their samples.
Eigen::MatrixXd averaging(const reading::DayRecord& record, std::size_t set_ups) {
    Eigen::MatrixXd mean =
        Eigen::MatrixXd::Zero(static_cast<Index>(set_ups), std::ssize(record.bins));
    for (std::size_t i = 0; i < record.bins.size(); ++i)
        mean(static_cast<Index>(record.bins[i].set_up), static_cast<Index>(i)) =
            static_cast<double>(record.bins[i].times.size());
    return mean.array().colwise() / mean.rowwise().sum().array();
}

constexpr double kNothing = 1e-6;  // relative length that is left by rounding

/// A direction in the residuals, of length 1 or 0, and its part in the scatter.
struct Direction {
    Eigen::VectorXd unit, scatter;
};

/// The means of the set-ups as residuals.  If the model fits, they are independent errors of variance
/// 1 without their part in the space of what nobody knows: constant and unknown stations.
struct SetUpResiduals {
    Eigen::VectorXd values;
    Eigen::MatrixXd whitening;  ///< (set-ups, set-ups)
    Eigen::MatrixXd unknown;    ///< Orthonormal basis of that space.
    /// Turns residuals into the scatter of the readings about the most likely course, in standard
    /// deviations of the noise alone.  What the priors expect and the day does not need has no part
    /// in it, so that priors may be too wide.
    Eigen::MatrixXd to_scatter;

    /// Removes what the unknown quantities explain.
    void project(Eigen::VectorXd& whitened) const {
        whitened -= unknown * (unknown.transpose() * whitened);
    }

    /// Returns the direction in the residuals of an effect on the set-ups; 0 if the unknown
    /// quantities explain it.
    [[nodiscard]] Direction direction(const Eigen::VectorXd& effect) const {
        Eigen::VectorXd unit = whitening * effect;
        const double length = unit.norm();
        project(unit);
        unit = unit.norm() < kNothing * length ? Eigen::VectorXd::Zero(unit.size())
                                               : Eigen::VectorXd(unit.normalized());
        return {unit, to_scatter * unit};
    }
};

SetUpResiduals residuals_of(const DayProblem& problem, const reading::DayRecord& record,
                            const DayFit& fit, const Eigen::MatrixXd& mean) {
    const Eigen::MatrixXd scaled = mean * problem.scaled(fit.expected);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(problem.estimated());
    for (std::size_t k = 0; k < kDayTerms; ++k)
        values(static_cast<Index>(k)) = fit.coefficients.at(k).value;
    const Eigen::MatrixXd lags = mean * problem.lag_columns(fit.expected, values);
    const Eigen::VectorXd deviations = problem.unscaling(fit.expected).diagonal();
    const Eigen::MatrixXd noise =
        mean * noise_covariance(record.bins, problem.noise(fit.expected)) * mean.transpose();
    Eigen::MatrixXd covariance = noise + lags * lags.transpose();
    std::vector<Index> unknown;
    for (Index k = 0; k < problem.estimated(); ++k) {
        if (deviations(k) == kFreeGravity_mgal)
            unknown.push_back(k + 1);
        else
            covariance += scaled.col(k + 1) * scaled.col(k + 1).transpose();
    }
    const linear_algebra::Cholesky factor(std::move(covariance));
    SetUpResiduals residuals;
    residuals.whitening.resize(mean.rows(), mean.rows());
    for (Index k = 0; k < mean.rows(); ++k)
        residuals.whitening.col(k) = factor.half_solve(Eigen::VectorXd::Unit(mean.rows(), k));
    // Readings minus their most likely course are V S^-1 y; V is the covariance of the noise alone, S
    // that with the priors.
    residuals.to_scatter =
        linear_algebra::Cholesky(noise).lower().transpose() * residuals.whitening.transpose();
    const Eigen::MatrixXd columns = residuals.whitening * scaled(Eigen::all, unknown);
    residuals.unknown = Eigen::HouseholderQR<Eigen::MatrixXd>(columns).householderQ() *
                        Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
    residuals.values = residuals.whitening * scaled.col(0);
    residuals.project(residuals.values);
    return residuals;
}

/// A statistic, 0 to 1, and the number of the direction that has most of it.
struct Statistic {
    double value = 0.0;
    std::size_t place = 0;
};

/// Residuals and their part in the scatter.
using Residuals = Direction;

/// Returns the largest share t^2 / (t^2 + scatter), where t is the part in one of the directions and
/// the scatter that of the readings without it.
Statistic largest_share(const std::vector<Direction>& directions, const Residuals& r) {
    Statistic best;
    const double square = r.scatter.squaredNorm();
    for (std::size_t k = 0; k < directions.size(); ++k) {
        const Direction& direction = directions[k];
        const double t = direction.unit.dot(r.unit);
        const double scatter = square - 2.0 * t * direction.scatter.dot(r.scatter) +
                               t * t * direction.scatter.squaredNorm();
        if (const double share = t * t / (t * t + scatter); share > best.value) best = {share, k};
    }
    return best;
}

/// Removes the part in a direction of length 1.
void remove(Direction& from, const Direction& taken) {
    const double part = taken.unit.dot(from.unit);
    from.unit -= part * taken.unit;
    from.scatter -= part * taken.scatter;
}

/// Returns the share of the scatter in a quarter of the directions, taken one after the other: each
/// time the one that leaves the least.
Statistic worst_quarter(std::vector<Direction> directions, const Residuals& r) {
    Residuals rest = r;
    Statistic first;
    for (std::size_t count = std::max<std::size_t>(1, directions.size() / 4); count > 0; --count) {
        const Statistic worst = largest_share(directions, rest);
        if (first.value == 0.0) first = worst;
        const Direction taken = directions[worst.place];
        remove(rest, taken);
        for (Direction& direction : directions) {
            remove(direction, taken);
            const double length = direction.unit.norm();
            const double scale = length < kNothing ? 0.0 : 1.0 / length;  // 0: it is used up
            direction.unit *= scale;
            direction.scatter *= scale;
        }
    }
    return {1.0 - rest.scatter.squaredNorm() / r.scatter.squaredNorm(), first.place};
}

/// Returns a vector of independent normal numbers of variance 1 (Box and Muller).
Eigen::VectorXd normal_vector(std::mt19937_64& generator, Index size) {
    const auto uniform = [&generator] {  // in (0, 1]
        return (static_cast<double>(generator() >> 11) + 1.0) * 0x1p-53;
    };
    Eigen::VectorXd values(size);
    for (double& value : values) {
        const double radius = std::sqrt(-2.0 * std::log(uniform()));
        value = radius * std::cos(2.0 * std::numbers::pi * uniform());
    }
    return values;
}

}  // namespace

std::vector<FitTest> goodness_of_fit(const reading::DayRecord& record,
                                     const std::vector<DayStation>& stations, const DayFit& fit,
                                     const DayPriors& priors) {
    const DayProblem problem(record, stations, priors);
    const Eigen::MatrixXd mean = averaging(record, stations.size());
    const SetUpResiduals residuals = residuals_of(problem, record, fit, mean);
    const Index set_ups = mean.rows();
    if (set_ups - residuals.unknown.cols() < kFewestFitDof) return {};

    std::vector<Direction> curves, steps, singles;
    for (const DayTerm term : {DayTerm::level, DayTerm::drift}) {
        const Eigen::VectorXd course =
            mean * problem.design(fit.point).col(static_cast<Index>(term));
        curves.push_back(residuals.direction((course.array() - course.mean()).square()));
    }
    for (Index k = 1; k < set_ups; ++k) {
        Eigen::VectorXd after = Eigen::VectorXd::Ones(set_ups);
        after.head(k).setZero();
        steps.push_back(residuals.direction(after));
    }
    for (Index k = 0; k < set_ups; ++k)
        singles.push_back(residuals.direction(Eigen::VectorXd::Unit(set_ups, k)));
    const auto statistics = [&](const Eigen::VectorXd& values) {
        const Residuals r{values, residuals.to_scatter * values};
        return std::array{largest_share(curves, r), largest_share(steps, r),
                          worst_quarter(singles, r)};
    };

    const auto found = statistics(residuals.values);
    std::array<int, 3> larger{};
    std::mt19937_64 generator(1);  // fixed seed: the same day gives the same probability
    for (int draw = 0; draw < kDraws; ++draw) {
        Eigen::VectorXd values = normal_vector(generator, set_ups);
        residuals.project(values);
        const auto simulated = statistics(values);
        for (std::size_t k = 0; k < found.size(); ++k)
            if (simulated.at(k).value >= found.at(k).value) ++larger.at(k);
    }
    const auto p = [&](std::size_t k) { return (1.0 + larger.at(k)) / (1.0 + kDraws); };
    return {{Misfit::curvature, p(0), found[0].place},
            {Misfit::step, p(1), found[1].place + 1},
            {Misfit::tails, p(2), found[2].place}};
}

}  // namespace a351::corrector::whole_day
