#include "corrector/whole_day/joint_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "corrector/whole_day/search_grid.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

/// Numbers of a point that move together.
template <std::size_t kCount>
struct Block {
    std::vector<std::size_t> surveys;  ///< Those whose equations they change.
    bool is_of_unit = false;           ///< They change the columns, not only the noise.
    std::array<std::function<double&(JointPoint&)>, kCount> numbers;
    std::size_t searched = kCount;  ///< The first of the numbers, which are not always 0.
};

/// All blocks of an adjustment.
struct Blocks {
    std::vector<Block<5>> units;       ///< Lags, size of the axis biases, effect of an outer oven.
    std::vector<Block<1>> placements;  ///< One for each group.
    std::vector<Block<2>> noises;      ///< Flicker and white noise of each survey.
};

Blocks blocks_of(const JointProblem& problem) {
    Blocks blocks;
    for (std::size_t unit = 0; unit < problem.unit_count(); ++unit)
        blocks.units.push_back(
            {problem.surveys_of_unit(unit),
             true,
             {[unit](JointPoint& point) -> double& { return point.units[unit][0]; },
              [unit](JointPoint& point) -> double& { return point.units[unit][1]; },
              [unit](JointPoint& point) -> double& { return point.units[unit][2]; },
              [unit](JointPoint& point) -> double& { return point.units[unit][3]; },
              [unit](JointPoint& point) -> double& { return point.units[unit][4]; }},
             problem.has_outer(unit) ? 5U : 3U});
    for (std::size_t group = 0; group < problem.groups().size(); ++group) {
        blocks.placements.push_back(
            {problem.groups()[group].surveys, false, {[group](JointPoint& point) -> double& {
                 return point.placements[group];
             }}});
        for (const std::size_t k : problem.groups()[group].surveys)
            blocks.noises.push_back(
                {{k},
                 false,
                 {[k](JointPoint& point) -> double& { return point.surveys[k][0]; },
                  [k](JointPoint& point) -> double& { return point.surveys[k][1]; }}});
    }
    return blocks;
}

/// A point that moves, with its equations.  A move of a few surveys costs those only.
class Walk {
public:
    Walk(const JointProblem& problem, JointPoint point)
        : problem_(problem), point_(std::move(point)), groups_(problem.groups().size()) {
        for (std::size_t k = 0; k < point_.surveys.size(); ++k) {
            every_survey_.push_back(k);
            scaled_.push_back(problem_.scaled(point_, k));
            surveys_.push_back(problem_.of_survey(point_, k, scaled_.back()));
        }
        for (std::size_t group = 0; group < groups_.size(); ++group) reduce(group);
    }

    [[nodiscard]] const JointPoint& point() const { return point_; }
    [[nodiscard]] const std::vector<std::size_t>& every_survey() const { return every_survey_; }

    [[nodiscard]] double cost() const {
        const Index size = problem_.common_count() + 1;
        JointProblem::Normal sum{Eigen::MatrixXd::Zero(size, size), 0.0};
        for (const JointProblem::Normal& group : groups_) {
            sum.products += group.products;
            sum.log_determinant += group.log_determinant;
        }
        return problem_.cost(point_, sum);
    }

    /// Moves to a point that differs for these surveys only.
    void move_to(JointPoint point, const std::vector<std::size_t>& surveys, bool is_of_unit) {
        point_ = std::move(point);
        std::vector<bool> is_moved(groups_.size(), false);
        for (const std::size_t k : surveys) {
            if (is_of_unit) scaled_[k] = problem_.scaled(point_, k);
            surveys_[k] = problem_.of_survey(point_, k, scaled_[k]);
            is_moved[problem_.group_of(k)] = true;
        }
        for (std::size_t group = 0; group < groups_.size(); ++group)
            if (is_moved[group]) reduce(group);
    }

    /// Moves the numbers of a block to the least cost.
    /// @return how far the farthest of them moved.
    template <std::size_t kCount>
    double settle(const Block<kCount>& block) {
        std::array<double, kCount> start{};
        for (std::size_t i = 0; i < kCount; ++i) start.at(i) = block.numbers.at(i)(point_);
        const auto place = [&](const std::array<double, kCount>& u) {
            JointPoint point = point_;
            for (std::size_t i = 0; i < kCount; ++i) block.numbers.at(i)(point) = u.at(i);
            move_to(std::move(point), block.surveys, block.is_of_unit);
        };
        const auto found = least_cost_point(
            [&](const std::array<double, kCount>& u) {
                place(u);
                return cost();
            },
            start, true,
            {.farthest = 12.0, .first_step = 0.25, .tolerance = 1e-2, .most_costs = 200},
            block.searched);
        place(found);
        double farthest = 0.0;
        for (std::size_t i = 0; i < kCount; ++i)
            farthest = std::max(farthest, std::abs(found.at(i) - start.at(i)));
        return farthest;
    }

    /// Returns the number of a block at which its standard deviation is the root of the expected
    /// variance (DayProblem::expected()).
    template <std::size_t kCount>
    double expected(const Block<kCount>& block, std::size_t number, double log_factor) {
        constexpr double kStep = 0.25;
        const JointPoint here = point_;
        const auto cost_at = [&](double move) {
            JointPoint point = here;
            block.numbers.at(number)(point) += move;
            move_to(std::move(point), block.surveys, block.is_of_unit);
            return cost();
        };
        const double curvature =
            (cost_at(kStep) - 2.0 * cost_at(0.0) + cost_at(-kStep)) / (kStep * kStep);
        move_to(here, block.surveys, block.is_of_unit);
        return block.numbers.at(number)(point_) + log_factor / std::max(curvature, 1.0);
    }

private:
    void reduce(std::size_t group) {
        groups_[group] = problem_.reduced(problem_.of_group(surveys_, group), group);
    }

    const JointProblem& problem_;
    JointPoint point_;
    std::vector<std::size_t> every_survey_;
    std::vector<Eigen::MatrixXd> scaled_;                 ///< One per survey.
    std::vector<JointProblem::Normal> surveys_, groups_;  ///< Groups without their own columns.
};

/// Moves all blocks in turn until none moves.
void settle(Walk& walk, const Blocks& blocks, bool with_units) {
    constexpr double kMoved = 0.02;  // deviations
    constexpr int kMostTurns = 8;
    for (int turn = 0; turn < kMostTurns; ++turn) {
        double farthest = 0.0;
        for (const auto& block : blocks.placements)
            farthest = std::max(farthest, walk.settle(block));
        for (const auto& block : blocks.noises) farthest = std::max(farthest, walk.settle(block));
        if (with_units)
            for (const auto& block : blocks.units)
                farthest = std::max(farthest, walk.settle(block));
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
        JointPoint point = walk.point();
        point.share = share;
        walk.move_to(std::move(point), walk.every_survey(), false);
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

JointPoint expected_point(Walk& walk, const JointProblem& problem, const Blocks& blocks) {
    JointPoint expected = walk.point();
    for (std::size_t unit = 0; unit < blocks.units.size(); ++unit) {
        const DayProblem& of_unit = problem.of(blocks.units[unit].surveys.front());
        expected.units[unit][2] =
            walk.expected(blocks.units[unit], 2, of_unit.log_factor(kBiasSize));
        if (problem.has_outer(unit))
            expected.units[unit][4] =
                walk.expected(blocks.units[unit], 4, of_unit.log_factor(kOuterSize));
    }
    for (std::size_t group = 0; group < blocks.placements.size(); ++group) {
        const DayProblem& of_group = problem.of(blocks.placements[group].surveys.front());
        expected.placements[group] =
            walk.expected(blocks.placements[group], 0, of_group.log_factor(kPlacement));
    }
    for (const Block<2>& block : blocks.noises) {
        const std::size_t k = block.surveys.front();
        expected.surveys[k][0] = walk.expected(block, 0, problem.of(k).log_factor(kFlicker));
    }
    return expected;
}

}  // namespace

JointSearch search(const JointProblem& problem, JointPoint start) {
    const Blocks blocks = blocks_of(problem);
    Walk walk(problem, std::move(start));
    settle(walk, blocks, true);
    JointSearch result;
    if (problem.has_boxes()) {
        result.share = search_share(walk, blocks);
        settle(walk, blocks, true);
    }
    result.most_likely = walk.point();
    result.expected = expected_point(walk, problem, blocks);
    return result;
}

}  // namespace a351::corrector::whole_day
