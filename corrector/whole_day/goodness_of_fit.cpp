#include "corrector/whole_day/goodness_of_fit.hpp"

#include <algorithm>
#include <random>

#include "corrector/whole_day/day_regression.hpp"
#include "corrector/whole_day/set_up_residuals.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

/// Number of simulated days.  Reason: a probability of 1 % has a standard error of 0.2 %.
constexpr int kDraws = 2000;

constexpr double kNothing = 1e-6;  // relative length that is left by rounding

using Direction = adjustment::Direction;

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

}  // namespace

std::vector<FitTest> goodness_of_fit(const DaySurvey& survey, const DayFit& fit) {
    const DayRegression problem(survey);
    const Eigen::MatrixXd mean = averaging(*survey.record, survey.stations.size());
    const adjustment::DenseResiduals residuals =
        set_up_residuals(survey, fit, NoiseCovariance(survey.record->bins));
    const Index set_ups = mean.rows();
    if (set_ups - residuals.unknown.cols() < kFewestFitDof) return {};

    // An effect on the bias has the sign of the face in the readings.
    const std::vector<double> faces =
        reading::faces_of(survey.record->bins, static_cast<std::size_t>(set_ups));
    const Eigen::Map<const Eigen::VectorXd> face(faces.data(), set_ups);
    std::vector<Direction> curves, steps, singles;
    for (const DayTerm term : {DayTerm::level, DayTerm::drift}) {
        const Eigen::VectorXd course =
            mean * problem.design(fit.point).col(static_cast<Index>(term));
        curves.push_back(
            residuals.direction(face.array() * (course.array() - course.mean()).square()));
    }
    for (Index k = 1; k < set_ups; ++k) {
        Eigen::VectorXd after = Eigen::VectorXd::Ones(set_ups);
        after.head(k).setZero();
        steps.push_back(residuals.direction(face.cwiseProduct(after)));
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
        const auto simulated = statistics(residuals.simulated(generator));
        for (std::size_t k = 0; k < found.size(); ++k)
            if (simulated.at(k).value >= found.at(k).value) ++larger.at(k);
    }
    const auto p = [&](std::size_t k) { return (1.0 + larger.at(k)) / (1.0 + kDraws); };
    return {{Misfit::curvature, p(0), found[0].place},
            {Misfit::step, p(1), found[1].place + 1},
            {Misfit::tails, p(2), found[2].place}};
}

}  // namespace a351::corrector::whole_day
