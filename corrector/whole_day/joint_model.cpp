#include "corrector/whole_day/joint_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "corrector/reading/on_all_cores.hpp"
#include "corrector/whole_day/joint_search.hpp"
#include "protocol/linear_algebra/cholesky.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

/// Returns the fits of the surveys alone.
std::vector<DayFit> fits_alone(const std::vector<JointSurvey>& surveys) {
    std::vector<DayFit> fits(surveys.size());
    reading::on_all_cores(surveys.size(), [&](std::size_t k) {
        fits[k] =
            fit_day(*surveys[k].record, surveys[k].stations, nullptr, surveys[k].priors).value();
    });
    return fits;
}

/// Returns the gravities that are held, and of the others the mean of the surveys.
std::vector<StationGravity> rough_gravities(const std::vector<JointSurvey>& surveys,
                                            const std::vector<DayFit>& fits) {
    std::size_t count = 0;
    for (const JointSurvey& survey : surveys)
        for (const std::size_t number : survey.gravities) count = std::max(count, number + 1);
    std::vector<StationGravity> gravities(count);
    std::vector<double> sums(count), counts(count);
    for (std::size_t k = 0; k < surveys.size(); ++k) {
        const auto& numbers = surveys[k].gravities;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            sums[numbers[i]] += fits[k].gravity_mgal[i].value;
            counts[numbers[i]] += 1.0;
        }
        for (const DayStation& station : surveys[k].stations) {
            if (!station.gravity) continue;
            StationGravity& gravity = gravities[numbers[station.number]];
            gravity.is_held = true;
            gravity.u_mgal = station.u_gravity.value();
            gravity.fitted_mgal = station.gravity->value();
        }
    }
    for (std::size_t number = 0; number < count; ++number)
        if (!gravities[number].is_held && counts[number] > 0.0)
            gravities[number].fitted_mgal = sums[number] / counts[number];
    return gravities;
}

/// Returns the mean point of the surveys alone: of a unit over its days, of a box over its sensors.
JointPoint start_of(const JointProblem& problem, const std::vector<DayFit>& fits) {
    JointPoint start;
    for (std::size_t unit = 0; unit < problem.unit_count(); ++unit) {
        const std::vector<std::size_t> days = problem.surveys_of_unit(unit);
        auto& of_unit = start.units.emplace_back();
        for (const std::size_t k : days) {
            of_unit[0] += fits[k].point[kFastLag] / static_cast<double>(days.size());
            of_unit[1] += fits[k].point[kSlowLag] / static_cast<double>(days.size());
            of_unit[2] += fits[k].point[kBiasSize] / static_cast<double>(days.size());
            of_unit[3] += fits[k].point[kOuterLag] / static_cast<double>(days.size());
            of_unit[4] += fits[k].point[kOuterSize] / static_cast<double>(days.size());
        }
    }
    for (const JointProblem::Group& group : problem.groups()) {
        double sum = 0.0;
        for (const std::size_t k : group.surveys) sum += fits[k].point[kPlacement];
        start.placements.push_back(sum / static_cast<double>(group.surveys.size()));
    }
    for (const DayFit& fit : fits)
        start.surveys.push_back({fit.point[kFlicker], fit.point[kWhite]});
    start.share = problem.has_boxes() ? 0.5 : 0.0;
    return start;
}

/// Returns the normal matrix of the unknowns in these places: products, and the priors.
Eigen::MatrixXd information(const Eigen::MatrixXd& products, const std::vector<Index>& places) {
    Eigen::MatrixXd matrix = products(places, places);
    matrix.diagonal().array() += 1.0;
    return matrix;
}

/// The system at the expected noise, with columns for the lags, and for gravities without reference.
class LastStep {
public:
    LastStep(const JointProblem& problem, const std::vector<JointSurvey>& surveys,
             const JointSearch& found)
        : problem_(problem), surveys_(surveys), found_(found) {
        solution_ = problem.solve(found.most_likely);
        expected_ = problem.solve(found.expected).common;
        std::vector<JointProblem::Normal> normals;
        for (std::size_t k = 0; k < surveys.size(); ++k) {
            const DayProblem::Point u = problem.point_of(found.most_likely, k);
            values_.push_back(problem.of(k).unscaled(u, solution_.surveys[k]));
            normals.push_back(problem.of_survey(found.expected, k,
                                                problem.scaled(found.expected, k), &values_[k]));
        }
        for (std::size_t group = 0; group < problem.groups().size(); ++group) {
            groups_.push_back(problem.of_group(normals, group, true));
            const Eigen::MatrixXd reduced = problem.reduced(groups_.back(), group).products;
            if (group == 0) products_ = Eigen::MatrixXd::Zero(reduced.rows(), reduced.cols());
            products_ += reduced;
        }
        for (Index k = 0; k < problem.common_count(); ++k) fitted_.push_back(k);
        covariance_ = linear_algebra::Cholesky(information(products_, fitted_)).inverse();
    }

    [[nodiscard]] Estimate gravity(std::size_t number, const StationGravity& rough) const {
        const Index place = problem_.place_of(number);
        if (place < 0) return {rough.fitted_mgal, 0.0};
        const double deviation_mgal = rough.is_held ? rough.u_mgal : kFreeGravity_mgal;
        return {rough.fitted_mgal + deviation_mgal * solution_.common(place),
                deviation_mgal * std::sqrt(covariance_(place, place))};
    }

    [[nodiscard]] StationSystem system(std::vector<StationGravity> gravities) const {
        // The readings are last.  Residuals meet only columns that the fit lacks.
        const Index all = products_.cols() - 1;
        Eigen::VectorXd gradient = Eigen::VectorXd::Zero(all);
        for (std::size_t number = 0; number < gravities.size(); ++number) {
            StationGravity& gravity = gravities[number];
            gravity.held = gravity.own = problem_.place_of(number);
            if (!gravity.is_held) continue;
            gravity.own = problem_.own_place_of(number);
            gradient(gravity.own) =
                products_(gravity.own, all) -
                products_.row(gravity.own).head(expected_.size()).dot(expected_);
        }
        std::vector<Index> kept = fitted_;
        for (StationGravity& gravity : gravities)
            if (gravity.is_held) {
                kept.push_back(gravity.own);
                gravity.own = std::ssize(kept) - 1;
            }
        return {std::move(gravities), products_(kept, kept), gradient(kept)};
    }

    [[nodiscard]] JointSurveyFit survey(std::size_t k) const {
        const DayProblem& problem = problem_.of(k);
        const DayProblem::Point u = problem_.point_of(found_.expected, k);
        const Eigen::MatrixXd unscaling = problem.unscaling(u);
        const Eigen::MatrixXd covariance = covariance_of(k);
        const Eigen::VectorXd errors =
            (unscaling * covariance * unscaling.transpose()).diagonal().cwiseSqrt();
        JointSurveyFit fit;
        for (Index term = 0; term < kTerms; ++term)
            fit.coefficients.at(static_cast<std::size_t>(term)) = {values_[k](term), errors(term)};
        for (Index i = problem.steps_begin(); i < problem.states_begin(); ++i)
            fit.steps_mgal.push_back({values_[k](i), errors(i)});
        fit.outer = problem.outer_response(u, values_[k], errors);
        const Eigen::MatrixXd factor = surveys_[k].priors.factor.topLeftCorner<kLags, kLags>();
        const Eigen::MatrixXd of_lags =
            factor * covariance.bottomRightCorner(kLags, kLags) * factor.transpose();
        for (const DayHyper lag : {kFastLag, kSlowLag}) {
            fit.lags_s.at(lag) = problem.lag_s(u, lag);
            fit.lag_log_errors.at(lag) =
                std::sqrt(of_lags(static_cast<Index>(lag), static_cast<Index>(lag)));
        }
        fit.noise = problem.noise(problem_.point_of(found_.most_likely, k));
        return fit;
    }

private:
    /// Returns the covariance of a survey's coefficients, the lags last.
    [[nodiscard]] Eigen::MatrixXd covariance_of(std::size_t survey) const {
        const std::size_t number = problem_.group_of(survey);
        const Index own = problem_.groups()[number].own_count;
        const Eigen::MatrixXd& products = groups_[number].products;
        std::vector<Index> owns, commons;
        for (Index k = 0; k < own; ++k) owns.push_back(k);
        for (const Index k : fitted_) commons.push_back(own + k);
        const linear_algebra::Cholesky factor(information(products, owns));
        // own = K^-1 (X'y - B common): with V the covariance of the common unknowns, that of the own
        // ones is K^-1 + (K^-1 B) V (K^-1 B)'.
        const Eigen::MatrixXd answer = factor.solve(products(owns, commons));
        Eigen::MatrixXd all(own + covariance_.rows(), own + covariance_.rows());
        all << factor.inverse() + answer * covariance_ * answer.transpose(), -answer * covariance_,
            -(answer * covariance_).transpose(), covariance_;
        const std::vector<Index> every = problem_.places_in_group(survey, true);
        const Index estimated = problem_.of(survey).estimated();
        std::vector<Index> places(every.begin() + 1, every.begin() + 1 + estimated);
        const auto lags = every.end() - std::ssize(surveys_[survey].gravities) - kLags;
        places.insert(places.end(), lags, lags + kLags);
        return all(places, places);
    }

    const JointProblem& problem_;
    const std::vector<JointSurvey>& surveys_;
    const JointSearch& found_;
    JointProblem::Solution solution_;      ///< With the most likely noise.
    Eigen::VectorXd expected_;             ///< Its common coefficients with the expected noise.
    std::vector<Eigen::VectorXd> values_;  ///< Estimates of each survey.
    std::vector<JointProblem::Normal> groups_;  ///< With the groups' own columns.
    Eigen::MatrixXd products_;    ///< Products of all common columns and the readings.
    std::vector<Index> fitted_;   ///< Common columns of the fit.
    Eigen::MatrixXd covariance_;  ///< Covariance of the coefficients of `fitted_`.
};

}  // namespace

JointFit fit_jointly(const std::vector<JointSurvey>& surveys) {
    const std::vector<DayFit> alone = fits_alone(surveys);
    const std::vector<StationGravity> rough = rough_gravities(surveys, alone);
    std::vector<double> rough_mgal;
    for (const StationGravity& gravity : rough) rough_mgal.push_back(gravity.fitted_mgal);
    const JointProblem problem(surveys, rough_mgal);
    const JointSearch found = search(problem, start_of(problem, alone));
    const LastStep last(problem, surveys, found);
    std::vector<StationGravity> fitted = rough;
    std::vector<Estimate> gravities;
    for (std::size_t number = 0; number < rough.size(); ++number) {
        gravities.push_back(last.gravity(number, rough[number]));
        fitted[number].fitted_mgal = gravities.back().value;
    }
    std::vector<JointSurveyFit> fits;
    for (std::size_t k = 0; k < surveys.size(); ++k) fits.push_back(last.survey(k));
    for (std::size_t unit = 0; unit < problem.unit_count(); ++unit) {
        const std::vector<std::size_t> days = problem.surveys_of_unit(unit);
        const auto of_unit =
            std::ranges::find_if(days, [&](std::size_t k) { return fits[k].outer.has_value(); });
        if (of_unit == days.end()) continue;
        for (const std::size_t k : days)
            if (!fits[k].outer) fits[k].outer = fits[*of_unit].outer;
    }
    return {std::move(fits), std::move(gravities), found.share, last.system(std::move(fitted))};
}

}  // namespace a351::corrector::whole_day
