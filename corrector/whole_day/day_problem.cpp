#include "corrector/whole_day/day_problem.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/linear_algebra/cholesky.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

/// Returns true for a term that each survey has for itself.
bool is_of_survey(Index term) {
    return kDayTermList.at(static_cast<std::size_t>(term))->scope == adjustment::Scope::loop;
}

/// Number of common columns of a unit without an outer oven: its terms, then its lags.
Index columns_of_unit() {
    Index count = kLags;
    for (Index term = 0; term < kTerms; ++term) count += is_of_survey(term) ? 0 : 1;
    return count;
}

/// A set-up of a survey: its station in the adjustment, and the time of its bins.
struct Stay {
    std::size_t gravity = 0;
    UtcTime first, last;
};

/// Returns the number of a survey's gravity in the adjustment.
std::size_t number_of(const DaySurvey& survey, std::size_t number) {
    return survey.gravities.empty() ? number : survey.gravities[number];
}

/// Returns the number of gravities of a survey.
std::size_t count_of(const DaySurvey& survey) {
    std::size_t count = 0;
    for (const DayStation& station : survey.stations) count = std::max(count, station.number + 1);
    return count;
}

std::vector<Stay> stays_of(const DaySurvey& survey) {
    std::vector<Stay> stays(survey.stations.size());
    for (std::size_t i = 0; i < stays.size(); ++i)
        stays[i].gravity = number_of(survey, survey.stations[i].number);
    std::vector<bool> is_begun(stays.size(), false);
    for (const reading::DayBin& bin : survey.record->bins) {
        Stay& stay = stays[bin.set_up];
        if (!is_begun[bin.set_up]) stay.first = bin.times.front();
        is_begun[bin.set_up] = true;
        stay.last = bin.times.back();
    }
    return stays;
}

bool are_one(const Stay& a, const Stay& b) {
    return a.gravity == b.gravity && a.first < b.last && b.first < a.last;
}

}  // namespace

Eigen::MatrixXd with_priors(const Eigen::MatrixXd& products, Index count) {
    Eigen::MatrixXd information = products.topLeftCorner(count, count);
    information.diagonal().array() += 1.0;
    return information;
}

DayProblem::DayProblem(std::vector<DaySurvey> surveys, std::vector<double> rough_mgal,
                       std::vector<WhiteSurvey> white_surveys)
    : surveys_(std::move(surveys)),
      white_surveys_(std::move(white_surveys)),
      rough_mgal_(std::move(rough_mgal)) {
    std::size_t gravities = 0;
    for (const DaySurvey& survey : surveys_) {
        std::vector<double> rough;
        for (std::size_t number = 0; number < count_of(survey); ++number) {
            gravities = std::max(gravities, number_of(survey, number) + 1);
            if (!rough_mgal_.empty()) rough.push_back(rough_mgal_[number_of(survey, number)]);
        }
        regressions_.push_back(std::make_unique<DayRegression>(survey, rough));
        unit_count_ = std::max(unit_count_, survey.unit + 1);
    }
    for (const WhiteSurvey& survey : white_surveys_)
        for (const DayStation& station : survey.stations)
            gravities = std::max(gravities, station.number + 1);
    places_.assign(gravities, -1);
    set_groups();
    set_hypers();
    set_columns();
    if (!white_surveys_.empty()) add_white_surveys();
}

void DayProblem::set_groups() {
    std::vector<std::vector<Stay>> stays;
    for (const DaySurvey& survey : surveys_) stays.push_back(stays_of(survey));
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

void DayProblem::set_hypers() {
    for (std::size_t unit = 0; unit < unit_count_; ++unit)
        for (const DayHyper lag : {kFastLag, kSlowLag})
            hypers_.push_back({lag, surveys_of_unit(unit)});
    for (const Group& group : groups_) hypers_.push_back({kPlacement, group.surveys});
    for (std::size_t k = 0; k < surveys_.size(); ++k)
        for (const DayHyper part : {kFlicker, kWhite}) hypers_.push_back({part, {k}});
    for (std::size_t unit = 0; unit < unit_count_; ++unit) {
        hypers_.push_back({kBiasSize, surveys_of_unit(unit)});
        if (on_scale_of(unit) > 0) hypers_.push_back({kScaleShare, surveys_of_unit(unit)});
        if (!has_outer(unit)) continue;
        for (const DayHyper part : {kOuterLag, kOuterSize})
            hypers_.push_back({part, surveys_of_unit(unit)});
    }
}

void DayProblem::set_columns() {
    for (std::size_t unit = 0; unit < unit_count_; ++unit) {
        unit_begin_.push_back(common_count_);
        common_count_ +=
            columns_of_unit() + (has_outer(unit) ? kOuterSlopes : 0) + on_scale_of(unit);
    }
    for (std::size_t k = 0; k < surveys_.size(); ++k)
        for (std::size_t number = 0; number < count_of(surveys_[k]); ++number) {
            Index& place = places_[gravity_of(k, number)];
            if (place < 0 && of(k).place_of(number) >= 0) place = common_count_++;
        }
    for (const WhiteSurvey& survey : white_surveys_)
        for (const DayStation& station : survey.stations) {
            Index& place = places_[station.number];
            if (place < 0 && station.deviation_mgal() > 0.0) place = common_count_++;
        }
    own_begin_.resize(surveys_.size());
    for (Group& group : groups_) {
        // A single sensor does not need the columns of its set-ups.
        group.own_count = group.is_box() ? static_cast<Index>(group.set_up_count) : Index{0};
        for (const std::size_t k : group.surveys) {
            own_begin_[k] = group.own_count;
            for (Index term = 0; term < kTerms; ++term)
                group.own_count += is_of_survey(term) ? 1 : 0;
            group.own_count += of(k).outer_begin() - of(k).steps_begin();
        }
    }
}

void DayProblem::add_white_surveys() {
    const Index size = common_count_ + std::ssize(places_) + 1;
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(size, size);
    for (const WhiteSurvey& survey : white_surveys_) {
        // gravity = base + deviation x coefficient, and the misclosures count from the base.
        const Index stations = std::ssize(survey.stations);
        Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(stations + 1, size);
        for (Index k = 0; k < stations; ++k) {
            const DayStation& station = survey.stations[static_cast<std::size_t>(k)];
            if (const Index place = places_[station.number]; place >= 0)
                columns(k, place) = station.deviation_mgal();
            columns(k, own_place_of(station.number)) = kFreeGravity_mgal;
            columns(k, size - 1) = survey.block.gravities_mgal(k) - base_mgal(station);
        }
        columns(stations, size - 1) = 1.0;
        products += columns.transpose() * survey.block.products * columns;
    }
    groups_.emplace_back().of_white_surveys = std::move(products);
}

bool DayProblem::has_boxes() const { return std::ranges::any_of(groups_, &Group::is_box); }

double DayProblem::in_common_mgal(const DayPoint& point, std::size_t survey, std::size_t set_up,
                                  const Eigen::VectorXd& of_box) const {
    const Group& group = groups_[group_of_[survey]];
    if (!group.is_box()) return 0.0;
    const std::size_t number = group.set_ups[place_in_group_[survey]][set_up];
    return std::sqrt(point.share) * of(survey).noise(part_of(point, survey)).placement_mgal *
           of_box(static_cast<Index>(number));
}

bool DayProblem::has_outer(std::size_t unit) const {
    return std::ranges::any_of(surveys_of_unit(unit),
                               [this](std::size_t k) { return of(k).has_outer(); });
}

Index DayProblem::on_scale_of(std::size_t unit) const {
    Index most = 0;
    for (const std::size_t k : surveys_of_unit(unit)) most = std::max(most, of(k).on_scale());
    return most;
}

std::vector<std::size_t> DayProblem::surveys_of_unit(std::size_t unit) const {
    std::vector<std::size_t> surveys;
    for (std::size_t k = 0; k < surveys_.size(); ++k)
        if (surveys_[k].unit == unit) surveys.push_back(k);
    return surveys;
}

std::vector<Index> DayProblem::places_in_group(std::size_t survey, bool is_extended) const {
    const Group& group = groups_[group_of_[survey]];
    const DayRegression& problem = of(survey);
    const Index common = group.own_count;
    const Index unit = common + unit_begin_[surveys_[survey].unit];
    const Index extra = is_extended ? std::ssize(places_) : 0;
    std::vector<Index> places{common + common_count_ + extra};
    Index own = own_begin_[survey], of_unit = unit;
    for (Index term = 0; term < kTerms; ++term)
        places.push_back(is_of_survey(term) ? own++ : of_unit++);
    places.resize(static_cast<std::size_t>(problem.steps_begin()) + 1);
    const std::size_t gravities = count_of(surveys_[survey]);
    for (std::size_t number = 0; number < gravities; ++number)
        if (const Index place = problem.place_of(number); place >= 0)
            places[static_cast<std::size_t>(place) + 1] =
                common + places_[gravity_of(survey, number)];
    for (Index k = problem.steps_begin(); k < problem.outer_begin(); ++k) places.push_back(own++);
    for (Index k = problem.outer_begin(); k < problem.on_scale_begin(); ++k)
        places.push_back(unit + columns_of_unit() + k - problem.outer_begin());
    const Index outer = has_outer(surveys_[survey].unit) ? kOuterSlopes : 0;
    for (Index k = 0; k < problem.on_scale(); ++k)
        places.push_back(unit + columns_of_unit() + outer + k);
    if (group.is_box())
        for (Index k = 0; k < static_cast<Index>(group.set_up_count); ++k) places.push_back(k);
    if (!is_extended) return places;
    for (Index lag = 0; lag < kLags; ++lag) places.push_back(of_unit++);
    for (std::size_t number = 0; number < gravities; ++number)
        places.push_back(common + own_place_of(gravity_of(survey, number)));
    return places;
}

std::size_t DayProblem::gravity_of(std::size_t survey, std::size_t number) const {
    return number_of(surveys_[survey], number);
}

SurveyPoint DayProblem::part_of(const DayPoint& point, std::size_t survey) const {
    SurveyPoint part{};
    for (std::size_t i = 0; i < hypers_.size(); ++i)
        if (std::ranges::find(hypers_[i].surveys, survey) != hypers_[i].surveys.end())
            part.at(hypers_[i].kind) = point.u[i];
    return part;
}

DayNoise DayProblem::own_noise(const DayPoint& point, std::size_t survey) const {
    DayNoise noise = of(survey).noise(part_of(point, survey));
    if (groups_[group_of_[survey]].is_box()) noise.placement_mgal *= std::sqrt(1.0 - point.share);
    return noise;
}

Eigen::MatrixXd DayProblem::whitened(const DayPoint& point, std::size_t survey,
                                     const Eigen::MatrixXd& scaled, const Eigen::VectorXd* values,
                                     double& log_determinant) const {
    const Group& group = groups_[group_of_[survey]];
    const DaySurvey& of_survey = surveys_[survey];
    const auto& bins = of_survey.record->bins;
    const SurveyPoint u = part_of(point, survey);
    const Index in_box = group.is_box() ? static_cast<Index>(group.set_up_count) : Index{0};
    const Index gravities = static_cast<Index>(count_of(of_survey));
    const Index lags = scaled.cols() + in_box;
    Eigen::MatrixXd columns =
        Eigen::MatrixXd::Zero(scaled.rows(), lags + (values == nullptr ? 0 : kLags + gravities));
    columns.leftCols(scaled.cols()) = scaled;
    if (values != nullptr) columns.middleCols(lags, kLags) = of(survey).lag_columns(u, *values);
    const double in_common_mgal = std::sqrt(point.share) * of(survey).noise(u).placement_mgal;
    for (Index row = 0; row < columns.rows(); ++row) {
        const std::size_t set_up = bins[static_cast<std::size_t>(row)].set_up;
        const double face = bins[static_cast<std::size_t>(row)].face;
        if (group.is_box()) {
            const std::size_t number = group.set_ups[place_in_group_[survey]][set_up];
            columns(row, scaled.cols() + static_cast<Index>(number)) = face * in_common_mgal;
        }
        if (values != nullptr)
            columns(row, lags + kLags + static_cast<Index>(of_survey.stations[set_up].number)) =
                face * kFreeGravity_mgal;
    }
    log_determinant = of(survey).whiten(own_noise(point, survey), columns);
    return columns;
}

DayProblem::Normal DayProblem::of_survey(const DayPoint& point, std::size_t survey,
                                         const Eigen::MatrixXd& scaled,
                                         const Eigen::VectorXd* values) const {
    Normal normal;
    const Eigen::MatrixXd columns = whitened(point, survey, scaled, values, normal.log_determinant);
    normal.products = columns.transpose() * columns;
    return normal;
}

DayProblem::Normal DayProblem::of_group(const std::vector<Normal>& surveys, std::size_t group,
                                        bool is_extended) const {
    const Index extra = is_extended ? std::ssize(places_) : 0;
    const Index size = groups_[group].own_count + common_count_ + extra + 1;
    Normal normal{Eigen::MatrixXd::Zero(size, size), 0.0};
    for (const std::size_t survey : groups_[group].surveys) {
        const std::vector<Index> places = places_in_group(survey, is_extended);
        normal.products(places, places) += surveys[survey].products;
        normal.log_determinant += surveys[survey].log_determinant;
    }
    if (const Eigen::MatrixXd& all = groups_[group].of_white_surveys; all.size() > 0) {
        std::vector<Index> places;
        for (Index k = 0; k < common_count_ + extra; ++k) places.push_back(k);
        places.push_back(all.rows() - 1);
        normal.products += all(places, places);
    }
    return normal;
}

DayProblem::Normal DayProblem::reduced(const Normal& normal, std::size_t group) const {
    const Index own = groups_[group].own_count, rest = normal.products.rows() - own;
    if (own == 0) return normal;
    const linear_algebra::Cholesky factor(with_priors(normal.products, own));
    if (!factor.is_positive_definite())
        return {Eigen::MatrixXd::Zero(rest, rest), HUGE_VAL};  // overflow, far from the priors
    return {normal.products.bottomRightCorner(rest, rest) -
                normal.products.bottomLeftCorner(rest, own) *
                    factor.solve(normal.products.topRightCorner(own, rest)),
            normal.log_determinant + factor.log_determinant()};
}

double DayProblem::cost(const DayPoint& point, const Normal& sum) const {
    const linear_algebra::Cholesky factor(with_priors(sum.products, common_count_));
    if (!std::isfinite(sum.log_determinant) || !factor.is_positive_definite()) return HUGE_VAL;
    const Eigen::VectorXd half =
        factor.half_solve(sum.products.col(common_count_).head(common_count_));
    double twice = sum.log_determinant + factor.log_determinant() +
                   sum.products(common_count_, common_count_) - half.squaredNorm();
    for (const double value : point.u) twice += value * value;
    return 0.5 * twice;
}

DayProblem::Solution DayProblem::solve(const DayPoint& point,
                                       const std::vector<Eigen::MatrixXd>& scaled) const {
    std::vector<Normal> surveys, groups;
    for (std::size_t k = 0; k < surveys_.size(); ++k)
        surveys.push_back(of_survey(point, k, scaled[k]));
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(common_count_ + 1, common_count_ + 1);
    for (std::size_t group = 0; group < groups_.size(); ++group) {
        groups.push_back(of_group(surveys, group));
        products += reduced(groups.back(), group).products;
    }
    Solution solution{linear_algebra::Cholesky(with_priors(products, common_count_))
                          .solve(products.col(common_count_).head(common_count_)),
                      std::vector<Eigen::VectorXd>(surveys_.size())};
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
            of_one.resize(std::ssize(places) - 1);
            for (Index k = 0; k < of_one.size(); ++k)
                of_one(k) = coefficients(places[static_cast<std::size_t>(k) + 1]);
        }
    }
    return solution;
}

}  // namespace a351::corrector::whole_day
