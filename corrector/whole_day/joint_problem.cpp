#include "corrector/whole_day/joint_problem.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/linear_algebra/cholesky.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

/// Number of common columns of a unit without an outer oven: its terms, then its lags.
Index columns_of_unit() {
    Index count = kLags;
    for (Index term = 0; term < kTerms; ++term)
        count += is_of_survey(static_cast<DayTerm>(term)) ? 0 : 1;
    return count;
}

/// A set-up of a survey: its station in the adjustment, and the time of its bins.
struct Stay {
    std::size_t gravity = 0;
    UtcTime first, last;
};

std::vector<Stay> stays_of(const JointSurvey& survey) {
    std::vector<Stay> stays(survey.stations.size());
    for (std::size_t i = 0; i < stays.size(); ++i)
        stays[i].gravity = survey.gravities[survey.stations[i].number];
    std::vector<bool> is_begun(stays.size(), false);
    for (const reading::DayBin& bin : survey.record->bins) {
        Stay& stay = stays[bin.set_up];
        if (!is_begun[bin.set_up]) stay.first = bin.times.front();
        is_begun[bin.set_up] = true;
        stay.last = bin.times.back();
    }
    return stays;
}

/// Returns the normal matrix of the first unknowns: products, and the priors of variance 1.
Eigen::MatrixXd with_priors(const Eigen::MatrixXd& products, Index count) {
    Eigen::MatrixXd information = products.topLeftCorner(count, count);
    information.diagonal().array() += 1.0;
    return information;
}

bool are_one(const Stay& a, const Stay& b) {
    return a.gravity == b.gravity && a.first < b.last && b.first < a.last;
}

}  // namespace

JointProblem::JointProblem(const std::vector<JointSurvey>& surveys,
                           const std::vector<double>& rough_mgal)
    : surveys_(surveys) {
    for (const JointSurvey& survey : surveys) {
        std::vector<double> rough;
        for (const std::size_t number : survey.gravities) rough.push_back(rough_mgal[number]);
        problems_.push_back(
            std::make_unique<DayProblem>(*survey.record, survey.stations, survey.priors, rough));
        unit_count_ = std::max(unit_count_, survey.unit + 1);
    }
    places_.assign(rough_mgal.size(), -1);
    set_groups();
    set_columns();
}

void JointProblem::set_groups() {
    std::vector<std::vector<Stay>> stays;
    for (const JointSurvey& survey : surveys_) stays.push_back(stays_of(survey));
    const auto is_of_group = [&](const Group& group, std::size_t survey) {
        return std::ranges::any_of(group.surveys, [&](std::size_t other) {
            return std::ranges::any_of(stays[survey], [&](const Stay& stay) {
                return std::ranges::any_of(
                    stays[other], [&](const Stay& of_other) { return are_one(stay, of_other); });
            });
        });
    };
    group_of_.resize(surveys_.size());
    place_in_group_.resize(surveys_.size());
    for (std::size_t k = 0; k < surveys_.size(); ++k) {
        auto group =
            std::ranges::find_if(groups_, [&](const Group& one) { return is_of_group(one, k); });
        if (group == groups_.end()) group = groups_.insert(group, Group{});
        std::vector<std::size_t> numbers;
        for (const Stay& stay : stays[k]) {
            std::size_t number = group->set_up_count;
            for (std::size_t i = 0; i < group->surveys.size(); ++i)
                for (std::size_t s = 0; s < stays[group->surveys[i]].size(); ++s)
                    if (are_one(stay, stays[group->surveys[i]][s])) number = group->set_ups[i][s];
            group->set_up_count = std::max(group->set_up_count, number + 1);
            numbers.push_back(number);
        }
        group_of_[k] = static_cast<std::size_t>(group - groups_.begin());
        place_in_group_[k] = group->surveys.size();
        group->surveys.push_back(k);
        group->set_ups.push_back(std::move(numbers));
    }
}

void JointProblem::set_columns() {
    for (std::size_t unit = 0; unit < unit_count_; ++unit) {
        unit_begin_.push_back(common_count_);
        common_count_ += columns_of_unit() + (has_outer(unit) ? kOuterSlopes : 0);
    }
    for (std::size_t k = 0; k < surveys_.size(); ++k)
        for (std::size_t number = 0; number < surveys_[k].gravities.size(); ++number) {
            Index& place = places_[surveys_[k].gravities[number]];
            if (place < 0 && of(k).place_of(number) >= 0) place = common_count_++;
        }
    own_begin_.resize(surveys_.size());
    for (Group& group : groups_) {
        // A single sensor has no need of the columns of its set-ups.
        group.own_count =
            group.surveys.size() > 1 ? static_cast<Index>(group.set_up_count) : Index{0};
        for (const std::size_t k : group.surveys) {
            own_begin_[k] = group.own_count;
            for (Index term = 0; term < kTerms; ++term)
                group.own_count += is_of_survey(static_cast<DayTerm>(term)) ? 1 : 0;
            group.own_count += of(k).outer_begin() - of(k).steps_begin();
        }
    }
}

bool JointProblem::has_boxes() const {
    return std::ranges::any_of(groups_,
                               [](const Group& group) { return group.surveys.size() > 1; });
}

bool JointProblem::has_outer(std::size_t unit) const {
    return std::ranges::any_of(surveys_of_unit(unit),
                               [this](std::size_t k) { return of(k).has_outer(); });
}

std::vector<std::size_t> JointProblem::surveys_of_unit(std::size_t unit) const {
    std::vector<std::size_t> surveys;
    for (std::size_t k = 0; k < surveys_.size(); ++k)
        if (surveys_[k].unit == unit) surveys.push_back(k);
    return surveys;
}

std::vector<Index> JointProblem::places_in_group(std::size_t survey, bool is_extended) const {
    const Group& group = groups_[group_of_[survey]];
    const DayProblem& problem = of(survey);
    const Index common = group.own_count;
    const Index unit = common + unit_begin_[surveys_[survey].unit];
    const Index extra = is_extended ? std::ssize(places_) : 0;
    std::vector<Index> places{common + common_count_ + extra};
    Index own = own_begin_[survey], of_unit = unit;
    for (Index term = 0; term < kTerms; ++term)
        places.push_back(is_of_survey(static_cast<DayTerm>(term)) ? own++ : of_unit++);
    places.resize(static_cast<std::size_t>(problem.steps_begin()) + 1);
    for (std::size_t number = 0; number < surveys_[survey].gravities.size(); ++number)
        if (const Index place = problem.place_of(number); place >= 0)
            places[static_cast<std::size_t>(place) + 1] =
                common + places_[surveys_[survey].gravities[number]];
    for (Index k = problem.steps_begin(); k < problem.outer_begin(); ++k) places.push_back(own++);
    for (Index k = problem.outer_begin(); k < problem.estimated(); ++k)
        places.push_back(unit + columns_of_unit() + k - problem.outer_begin());
    if (group.surveys.size() > 1)
        for (Index k = 0; k < static_cast<Index>(group.set_up_count); ++k) places.push_back(k);
    if (!is_extended) return places;
    for (Index lag = 0; lag < kLags; ++lag) places.push_back(of_unit++);
    for (const std::size_t number : surveys_[survey].gravities)
        places.push_back(common + own_place_of(number));
    return places;
}

DayProblem::Point JointProblem::point_of(const JointPoint& point, std::size_t survey) const {
    const auto& unit = point.units[surveys_[survey].unit];
    DayProblem::Point u{};
    u[kFastLag] = unit[0];
    u[kSlowLag] = unit[1];
    u[kBiasSize] = unit[2];
    u[kOuterLag] = unit[3];
    u[kOuterSize] = unit[4];
    u[kPlacement] = point.placements[group_of_[survey]];
    u[kFlicker] = point.surveys[survey][0];
    u[kWhite] = point.surveys[survey][1];
    return u;
}

DayNoise JointProblem::own_noise(const JointPoint& point, std::size_t survey) const {
    DayNoise noise = of(survey).noise(point_of(point, survey));
    if (groups_[group_of_[survey]].surveys.size() > 1)
        noise.placement_mgal *= std::sqrt(1.0 - point.share);
    return noise;
}

JointProblem::Normal JointProblem::of_survey(const JointPoint& point, std::size_t survey,
                                             const Eigen::MatrixXd& scaled,
                                             const Eigen::VectorXd* values) const {
    const Group& group = groups_[group_of_[survey]];
    const JointSurvey& of_unit = surveys_[survey];
    const auto& bins = of_unit.record->bins;
    const DayProblem::Point u = point_of(point, survey);
    const bool is_in_box = group.surveys.size() > 1;
    const Index in_box = is_in_box ? static_cast<Index>(group.set_up_count) : Index{0};
    const Index extra = values != nullptr ? kLags + std::ssize(of_unit.gravities) : Index{0};
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(scaled.rows(), scaled.cols() + in_box + extra);
    columns.leftCols(scaled.cols()) = scaled;
    const Index lags = scaled.cols() + in_box;
    if (values != nullptr) columns.middleCols(lags, kLags) = of(survey).lag_columns(u, *values);
    const double in_common_mgal = std::sqrt(point.share) * of(survey).noise(u).placement_mgal;
    for (Index row = 0; row < columns.rows(); ++row) {
        const std::size_t set_up = bins[static_cast<std::size_t>(row)].set_up;
        if (is_in_box) {
            const std::size_t number = group.set_ups[place_in_group_[survey]][set_up];
            columns(row, scaled.cols() + static_cast<Index>(number)) = in_common_mgal;
        }
        if (values != nullptr)
            columns(row, lags + kLags + static_cast<Index>(of_unit.stations[set_up].number)) =
                kFreeGravity_mgal;
    }
    const double log_determinant = whiten(bins, own_noise(point, survey), columns);
    return {columns.transpose() * columns, log_determinant};
}

JointProblem::Normal JointProblem::of_group(const std::vector<Normal>& surveys, std::size_t group,
                                            bool is_extended) const {
    const Index extra = is_extended ? std::ssize(places_) : 0;
    const Index size = groups_[group].own_count + common_count_ + extra + 1;
    Normal normal{Eigen::MatrixXd::Zero(size, size), 0.0};
    for (const std::size_t survey : groups_[group].surveys) {
        const std::vector<Index> places = places_in_group(survey, is_extended);
        normal.products(places, places) += surveys[survey].products;
        normal.log_determinant += surveys[survey].log_determinant;
    }
    return normal;
}

JointProblem::Normal JointProblem::reduced(const Normal& normal, std::size_t group) const {
    const Index own = groups_[group].own_count, rest = normal.products.rows() - own;
    const linear_algebra::Cholesky factor(with_priors(normal.products, own));
    if (!factor.is_positive_definite())
        return {Eigen::MatrixXd::Zero(rest, rest), HUGE_VAL};  // overflow, far from the priors
    return {normal.products.bottomRightCorner(rest, rest) -
                normal.products.bottomLeftCorner(rest, own) *
                    factor.solve(normal.products.topRightCorner(own, rest)),
            normal.log_determinant + factor.log_determinant()};
}

double JointProblem::cost(const JointPoint& point, const Normal& sum) const {
    const linear_algebra::Cholesky factor(with_priors(sum.products, common_count_));
    if (!std::isfinite(sum.log_determinant) || !factor.is_positive_definite()) return HUGE_VAL;
    const Eigen::VectorXd half =
        factor.half_solve(sum.products.col(common_count_).head(common_count_));
    double twice = sum.log_determinant + factor.log_determinant() +
                   sum.products(common_count_, common_count_) - half.squaredNorm();
    const auto add = [&twice](const auto& values) {
        for (const double value : values) twice += value * value;
    };
    for (const auto& unit : point.units) add(unit);
    for (const auto& survey : point.surveys) add(survey);
    add(point.placements);
    return 0.5 * twice;
}

JointProblem::Solution JointProblem::solve(const JointPoint& point) const {
    std::vector<Normal> surveys, groups;
    for (std::size_t k = 0; k < surveys_.size(); ++k)
        surveys.push_back(of_survey(point, k, scaled(point, k)));
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(common_count_ + 1, common_count_ + 1);
    for (std::size_t group = 0; group < groups_.size(); ++group) {
        groups.push_back(of_group(surveys, group));
        products += reduced(groups.back(), group).products;
    }
    Solution solution;
    solution.common = linear_algebra::Cholesky(with_priors(products, common_count_))
                          .solve(products.col(common_count_).head(common_count_));
    solution.surveys.resize(surveys_.size());
    for (std::size_t group = 0; group < groups_.size(); ++group) {
        const Index own = groups_[group].own_count;
        const Eigen::MatrixXd& all = groups[group].products;
        Eigen::VectorXd coefficients(own + common_count_);
        coefficients << linear_algebra::Cholesky(with_priors(all, own))
                            .solve(all.col(own + common_count_).head(own) -
                                   all.block(0, own, own, common_count_) * solution.common),
            solution.common;
        for (const std::size_t survey : groups_[group].surveys) {
            const std::vector<Index> places = places_in_group(survey, false);
            Eigen::VectorXd& of_one = solution.surveys[survey];
            of_one.resize(of(survey).estimated());
            for (Index k = 0; k < of_one.size(); ++k)
                of_one(k) = coefficients(places[static_cast<std::size_t>(k) + 1]);
        }
    }
    return solution;
}

}  // namespace a351::corrector::whole_day
