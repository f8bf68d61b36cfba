#include "corrector/whole_day/day_search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "corrector/whole_day/least_cost.hpp"
#include "protocol/linear_algebra/cholesky.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

/// Numbers of a point, by their places in it.
using Block = std::vector<std::size_t>;

/// Step of a second derivative, in deviations.
constexpr double kCurvatureStep = 0.25;

/// A point that moves, with its equations.  A move of a few surveys costs those only.
class Walk {
public:
    Walk(const DayProblem& problem, DayPoint point)
        : problem_(problem),
          point_(std::move(point)),
          scaled_(problem.surveys().size()),
          surveys_(problem.surveys().size()),
          groups_(problem.groups().size()) {
        refresh(true, std::vector<bool>(surveys_.size(), true));
    }

    [[nodiscard]] const DayPoint& point() const { return point_; }

    [[nodiscard]] double cost() const {
        if (groups_.size() == 1) return problem_.cost(point_, groups_.front());
        const Index size = problem_.common_count() + 1;
        DayProblem::Normal sum{Eigen::MatrixXd::Zero(size, size), 0.0};
        for (const DayProblem::Normal& group : groups_) {
            sum.products += group.products;
            sum.log_determinant += group.log_determinant;
        }
        return problem_.cost(point_, sum);
    }

    void move_to(const DayPoint& point) {
        std::vector<bool> is_moved(surveys_.size(), point.share != point_.share);
        bool is_of_unit = false;
        for (std::size_t i = 0; i < point.u.size(); ++i) {
            if (point.u[i] == point_.u[i]) continue;
            is_of_unit = is_of_unit || problem_.hypers()[i].is_of_unit();
            for (const std::size_t survey : problem_.hypers()[i].surveys) is_moved[survey] = true;
        }
        point_ = point;
        refresh(is_of_unit, is_moved);
    }

    /// Returns the cost after a move.
    double cost_at(const DayPoint& point) {
        move_to(point);
        return cost();
    }

    /// Moves the numbers of a block to the least cost.
    /// @return how far the farthest of them moved.
    double settle(const Block& block, bool is_nearby, const SearchLimits& limits) {
        std::vector<double> start;
        for (const std::size_t i : block) start.push_back(point_.u[i]);
        const auto placed = [&](const std::vector<double>& u) {
            DayPoint point = point_;
            for (std::size_t i = 0; i < block.size(); ++i) point.u[block[i]] = u[i];
            return point;
        };
        const std::vector<double> found =
            least_cost_point([&](const std::vector<double>& u) { return cost_at(placed(u)); },
                             start, is_nearby, limits);
        move_to(placed(found));
        double farthest = 0.0;
        for (std::size_t i = 0; i < block.size(); ++i)
            farthest = std::max(farthest, std::abs(found[i] - start[i]));
        return farthest;
    }

private:
    void refresh(bool is_of_unit, const std::vector<bool>& is_moved) {
        std::vector<bool> is_group_moved(groups_.size());
        for (std::size_t k = 0; k < surveys_.size(); ++k) {
            if (!is_moved[k]) continue;
            if (is_of_unit)
                scaled_[k] = problem_.of(k).scaled(problem_.part_of(point_, k));
            surveys_[k] = problem_.of_survey(point_, k, scaled_[k]);
            is_group_moved[problem_.group_of(k)] = true;
        }
        for (std::size_t group = 0; group < groups_.size(); ++group)
            // The white surveys never move: their group is computed once.
            if (is_group_moved[group] || groups_[group].products.size() == 0)
                groups_[group] = problem_.reduced(problem_.of_group(surveys_, group), group);
    }

    const DayProblem& problem_;
    DayPoint point_;
    std::vector<Eigen::MatrixXd> scaled_;               ///< One per survey.
    std::vector<DayProblem::Normal> surveys_, groups_;  ///< Groups without their own columns.
};

/// Returns the places of all numbers of some kinds, those of the same surveys together.
std::vector<Block> blocks_of(const DayProblem& problem, const std::vector<DayHyper>& kinds) {
    std::vector<Block> blocks;
    const std::vector<Hyper>& hypers = problem.hypers();
    for (std::size_t i = 0; i < hypers.size(); ++i) {
        if (std::ranges::find(kinds, hypers[i].kind) == kinds.end()) continue;
        const auto block = std::ranges::find_if(blocks, [&](const Block& one) {
            return hypers[one.front()].surveys == hypers[i].surveys;
        });
        if (block == blocks.end())
            blocks.push_back({i});
        else
            block->push_back(i);
    }
    return blocks;
}

/// All blocks of an adjustment of several surveys.
struct Blocks {
    explicit Blocks(const DayProblem& problem)
        : of_noise(blocks_of(problem, {kPlacement})),
          of_units(blocks_of(problem,
                             {kFastLag, kSlowLag, kBiasSize, kOuterLag, kOuterSize, kScaleShare})) {
        for (Block& block : blocks_of(problem, {kFlicker, kWhite}))
            of_noise.push_back(std::move(block));
    }
    std::vector<Block> of_noise, of_units;
};

/// Moves all blocks in turn until none moves.
void settle(Walk& walk, const Blocks& blocks, bool with_units) {
    constexpr double kMoved = 0.02;  // deviations
    constexpr int kMostTurns = 8;
    constexpr SearchLimits kLimits{
        .farthest = 12.0, .first_step = 0.25, .tolerance = 1e-2, .most_costs = 200};
    for (int turn = 0; turn < kMostTurns; ++turn) {
        double farthest = 0.0;
        for (const Block& block : blocks.of_noise)
            farthest = std::max(farthest, walk.settle(block, true, kLimits));
        if (with_units)
            for (const Block& block : blocks.of_units)
                farthest = std::max(farthest, walk.settle(block, true, kLimits));
        if (farthest < kMoved) return;
    }
}

constexpr std::size_t kShareSteps = 10;

double share_at(std::size_t step) {
    return static_cast<double>(step) / static_cast<double>(kShareSteps);
}

/// Returns where a straight line through two costs has the value `limit`.
double crossing(const std::vector<double>& costs, std::size_t inside, std::size_t outside,
                double limit) {
    return share_at(inside) + (share_at(outside) - share_at(inside)) * (limit - costs[inside]) /
                                  (costs[outside] - costs[inside]);
}

/// Returns the share from its costs at equal steps.
PlacementShare share_of(const std::vector<double>& costs) {
    constexpr double kLimit = 1.920729;  // half of the 95 % point of chi-square, 1 dof
    const auto best = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
    PlacementShare share;
    double least = costs[best];
    share.most_likely = share_at(best);
    if (best > 0 && best < kShareSteps) {
        const double left = costs[best - 1] - least, right = costs[best + 1] - least;
        const double move = 0.5 * (left - right) / (left + right);  // -0.5 to 0.5 steps
        share.most_likely += move / static_cast<double>(kShareSteps);
        least -= 0.25 * (left - right) * move;
    }
    double weights = 0.0, sum = 0.0;
    for (std::size_t k = 0; k <= kShareSteps; ++k) {
        // Trapezoids: both ends have half the weight.
        const double weight = std::exp(least - costs[k]) * (k == 0 || k == kShareSteps ? 0.5 : 1.0);
        weights += weight;
        sum += weight * share_at(k);
    }
    share.expected = sum / weights;
    std::size_t low = best, high = best;
    while (low > 0 && costs[low - 1] <= least + kLimit) --low;
    while (high < kShareSteps && costs[high + 1] <= least + kLimit) ++high;
    share.lowest = low == 0 ? 0.0 : crossing(costs, low, low - 1, least + kLimit);
    share.highest = high == kShareSteps ? 1.0 : crossing(costs, high, high + 1, least + kLimit);
    return share;
}

/// Returns the share and moves to its expected value.
PlacementShare search_share(Walk& walk, const Blocks& blocks) {
    const auto settle_at = [&](double share) {
        DayPoint point = walk.point();
        point.share = share;
        walk.move_to(point);
        settle(walk, blocks, false);
        return walk.cost();
    };
    std::vector<double> costs;
    for (std::size_t step = 0; step <= kShareSteps; ++step)
        costs.push_back(settle_at(share_at(step)));
    const PlacementShare share = share_of(costs);
    settle_at(share.expected);
    return share;
}

/// Second derivatives of the cost at the point of a walk, which is elsewhere afterwards.
class Curvatures {
public:
    explicit Curvatures(Walk& walk) : walk_(walk), here_(walk.point()), cost_(walk.cost()) {}

    /// Returns the second derivative by two numbers.
    double of(std::size_t i, std::size_t k) {
        constexpr double kSquare = kCurvatureStep * kCurvatureStep;
        if (i == k) return along(i) / kSquare;
        return (both_sides({i, k}) - along(i) - along(k)) / (2.0 * kSquare);
    }

private:
    /// both_sides() of a number, computed once.
    double along(std::size_t i) {
        const auto known = along_.find(i);
        return known != along_.end() ? known->second
                                     : along_.emplace(i, both_sides({i})).first->second;
    }
    /// Returns f(+h) + f(-h) - 2 f(0) for a step of all numbers of a block.
    double both_sides(const Block& block) {
        double sum = -2.0 * cost_;
        for (const double step : {kCurvatureStep, -kCurvatureStep}) {
            DayPoint point = here_;
            for (const std::size_t i : block) point.u[i] += step;
            sum += walk_.cost_at(point);
        }
        return sum;
    }

    Walk& walk_;
    DayPoint here_;
    double cost_;
    std::map<std::size_t, double> along_;
};

/// Returns DaySearch::expected.
DayPoint expected_point(const DayProblem& problem, DayPoint most_likely, Curvatures& curvatures) {
    for (std::size_t i = 0; i < problem.hypers().size(); ++i) {
        const Hyper& hyper = problem.hypers()[i];
        if (hyper.kind != kPlacement && hyper.kind != kFlicker && hyper.kind != kBiasSize &&
            hyper.kind != kOuterSize)
            continue;
        // x = median factor^u.  If ln x is normal with the mean m and the variance v, the root of
        // the mean square of x is exp(m + v), with v = (ln factor)^2 / curvature.
        most_likely.u[i] += problem.of(hyper.surveys.front()).log_factor(hyper.kind) /
                            std::max(curvatures.of(i, i), 1.0);
    }
    return most_likely;
}

/// Returns DaySearch::u_errors.
std::vector<double> u_errors(const DayProblem& problem, Curvatures& curvatures) {
    std::vector<double> errors(problem.hypers().size());
    for (std::size_t i = 0; i < errors.size(); ++i)
        if (problem.hypers()[i].kind == kScaleShare)
            errors[i] = 1.0 / std::sqrt(std::max(curvatures.of(i, i), 1.0));
    return errors;
}

/// Returns DaySearch::noise_log_errors.
std::optional<std::array<double, 3>> noise_log_errors(const DayProblem& problem,
                                                      Curvatures& curvatures) {
    constexpr std::array kParts{kPlacement, kFlicker, kWhite};
    const auto place = [&](std::size_t part) {
        return static_cast<std::size_t>(
            std::ranges::find(problem.hypers(), kParts.at(part), &Hyper::kind) -
            problem.hypers().begin());
    };
    Eigen::Matrix3d curvature;
    for (std::size_t i = 0; i < kParts.size(); ++i)
        for (std::size_t k = 0; k <= i; ++k) {
            const auto row = static_cast<Index>(i), column = static_cast<Index>(k);
            curvature(row, column) = curvature(column, row) = curvatures.of(place(i), place(k));
        }
    const linear_algebra::Cholesky factor(curvature);
    if (!factor.is_positive_definite()) return std::nullopt;
    const Eigen::VectorXd variances = factor.inverse().diagonal();
    std::array<double, 3> errors{};
    for (std::size_t i = 0; i < errors.size(); ++i)
        errors.at(i) =
            problem.of(0).log_factor(kParts.at(i)) * std::sqrt(variances(static_cast<Index>(i)));
    return errors;
}

}  // namespace

DaySearch search_alone(const DayProblem& problem, const SurveyPoint* nearby) {
    DayPoint start{std::vector<double>(problem.hypers().size()), 0.0};
    if (nearby != nullptr) start = mean_point(problem, {*nearby});
    Walk walk(problem, start);
    double least = walk.cost();
    // From small biases the search may end where large ones are taken for a placement of 30 mGal.
    for (const double bias_size : {2.0, 4.0}) {
        SurveyPoint other{};
        other[kBiasSize] = bias_size;
        const DayPoint point = mean_point(problem, {other});
        if (nearby != nullptr || walk.cost_at(point) >= least) continue;
        least = walk.cost();
        start = point;
    }
    walk.move_to(start);
    Block every(problem.hypers().size());
    for (std::size_t i = 0; i < every.size(); ++i) every[i] = i;
    // Nearby, a first step of 0.1 needs fewer costs than 0.25: 0.92 of the time of twenty surveys.
    walk.settle(every, nearby != nullptr,
                {.farthest = 12.0,
                 .first_step = nearby != nullptr ? 0.1 : 0.5,
                 .tolerance = nearby != nullptr ? 1e-2 : 1e-3,
                 .most_costs = 2000});
    DaySearch found{walk.point(), {}, std::nullopt, std::nullopt};
    Curvatures curvatures(walk);
    found.expected = expected_point(problem, found.most_likely, curvatures);
    found.u_errors = u_errors(problem, curvatures);
    found.noise_log_errors = noise_log_errors(problem, curvatures);
    return found;
}

DaySearch search_together(const DayProblem& problem, DayPoint start) {
    const Blocks blocks(problem);
    Walk walk(problem, std::move(start));
    settle(walk, blocks, true);
    DaySearch found;
    if (problem.has_boxes()) {
        found.share = search_share(walk, blocks);
        settle(walk, blocks, true);
    }
    found.most_likely = walk.point();
    Curvatures curvatures(walk);
    found.expected = expected_point(problem, found.most_likely, curvatures);
    found.u_errors = u_errors(problem, curvatures);
    return found;
}

DayPoint mean_point(const DayProblem& problem, const std::vector<SurveyPoint>& parts) {
    DayPoint mean;
    for (const Hyper& hyper : problem.hypers()) {
        double& value = mean.u.emplace_back(0.0);
        for (const std::size_t survey : hyper.surveys)
            value += parts[survey].at(hyper.kind) / static_cast<double>(hyper.surveys.size());
    }
    return mean;
}

}  // namespace a351::corrector::whole_day
