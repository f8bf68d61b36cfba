#include "corrector/whole_day/day_fit.hpp"

#include <cmath>

#include "corrector/whole_day/day_adjustment.hpp"

namespace a351::corrector::whole_day {
namespace {

using Index = Eigen::Index;

/// Returns the term to whose effect that of a coefficient is added.
DayTerm term_of(const DayRegression& regression, Index coefficient) {
    if (coefficient < kTerms) return static_cast<DayTerm>(coefficient);
    if (coefficient < regression.states_begin()) return DayTerm::drift;  // steps
    if (coefficient >= regression.on_scale_begin())
        return DayRegression::kOnScale.at(
            static_cast<std::size_t>(coefficient - regression.on_scale_begin()));
    if (coefficient >= regression.outer_begin()) return DayTerm::slow;
    // States after gaps are in turn of the fast and of the slow lag.
    return (coefficient - regression.states_begin()) % 2 == 0 ? DayTerm::fast : DayTerm::slow;
}

}  // namespace

std::vector<DaySetUp> DayAdjustment::set_ups_of(std::size_t survey) const {
    const DayRegression& regression = problem_->of(survey);
    const DaySurvey& of = problem_->surveys()[survey];
    const Eigen::VectorXd& values = surveys_[survey].values;
    const SurveyPoint u = problem_->part_of(found_.most_likely, survey);
    std::vector<DaySetUp> means(of.stations.size());
    std::vector<double> counts(means.size());
    for (const reading::DayBin& bin : of.record->bins)
        counts[bin.set_up] += static_cast<double>(bin.times.size());
    const Eigen::MatrixXd x = regression.design(u);
    const Eigen::VectorXd temperature =
        regression.means().of(of.record->temperature.series.values());
    for (std::size_t i = 0; i < of.record->bins.size(); ++i) {
        const reading::DayBin& bin = of.record->bins[i];
        DaySetUp& mean = means[bin.set_up];
        const auto row = static_cast<Index>(i);
        const double weight = static_cast<double>(bin.times.size()) / counts[bin.set_up];
        mean.reading = mean.reading + MilliGal(weight * bin.face * regression.readings_mgal()(row));
        mean.tide = mean.tide + MilliGal(weight * bin.tide.value());
        mean.temperature = mean.temperature + DegC(weight * temperature(row));
        mean.rate_degc_per_h += weight * x(row, static_cast<Index>(DayTerm::fast));
        for (Index k = 0; k < regression.estimated(); ++k)
            if (k < kTerms || k >= regression.steps_begin())
                mean.effect_mgal.at(static_cast<std::size_t>(term_of(regression, k))) +=
                    weight * bin.face * values(k) * x(row, k);
    }
    for (std::size_t s = 0; s < means.size(); ++s) {
        DaySetUp& set_up = means[s];
        const std::size_t number = of.stations[s].number;
        const double base_mgal = regression.base_mgal()[number];
        const double gravity_mgal = gravities_[problem_->gravity_of(survey, number)].fitted_mgal;
        set_up.reading = MilliGal(base_mgal) + set_up.reading + set_up.tide;
        set_up.corrected = corrected(s, survey);
        // The column of the scale has the rough gravity.
        set_up.effect_mgal.at(static_cast<std::size_t>(DayTerm::scale)) +=
            (DayRegression::scale(values) - 1.0) * (gravity_mgal - base_mgal);
        double effects = 0.0;
        for (const double effect : set_up.effect_mgal) effects += effect;
        set_up.flicker = set_up.reading - set_up.tide - MilliGal(effects) - set_up.corrected;
    }
    return means;
}

DayFit DayAdjustment::fit(std::size_t survey) const {
    const DayRegression& regression = problem_->of(survey);
    const DayPriors& priors = problem_->surveys()[survey].priors;
    const SurveyPart& part = surveys_[survey];
    DayFit fit;
    fit.point = problem_->part_of(found_.most_likely, survey);
    fit.expected = problem_->part_of(found_.expected, survey);
    fit.noise = noise(survey);
    fit.expected_noise = expected_noise(survey);
    fit.fast_lag_s = regression.lag_s(fit.point, kFastLag);
    fit.slow_lag_s = regression.lag_s(fit.point, kSlowLag);
    const Eigen::MatrixXd scaled = covariance_of(survey);
    const Eigen::MatrixXd unscaling = regression.unscaling(fit.expected);
    const Eigen::VectorXd errors =
        (unscaling * scaled * unscaling.transpose()).diagonal().cwiseSqrt();
    const auto estimate = [&](Index k) { return Estimate{part.values(k), errors(k)}; };
    for (std::size_t k = 0; k < kDayTerms; ++k)
        fit.coefficients.at(k) = estimate(static_cast<Index>(k));
    for (Index k = regression.steps_begin(); k < regression.states_begin(); ++k)
        fit.steps_mgal.push_back(estimate(k));
    fit.outer = regression.outer_response(fit.point, part.values, errors);
    for (Index k = regression.on_scale_begin(); k < regression.estimated(); ++k)
        fit.on_scale.push_back(estimate(k));
    if (regression.on_scale() > 0) {
        const SurveyPoint u_errors =
            found_.u_errors.empty() ? SurveyPoint{} : problem_->part_of({found_.u_errors}, survey);
        fit.scale_share = {regression.scale_share(fit.point),
                           regression.scale_share_error(fit.point, u_errors)};
    }
    fit.noise_log_errors = found_.noise_log_errors;
    fit.shift << fit.point[kFastLag], fit.point[kSlowLag], part.scaled.head(kTerms);
    // The lags are last in `scaled` and first in the shift.
    fit.shift_covariance << scaled.bottomRightCorner(kLags, kLags),
        scaled.bottomLeftCorner(kLags, kTerms), scaled.topRightCorner(kTerms, kLags),
        scaled.topLeftCorner(kTerms, kTerms);
    const DayPriors::Matrix covariance =
        priors.factor * fit.shift_covariance * priors.factor.transpose();
    fit.lag_log_errors = {std::sqrt(covariance(kFastLag, kFastLag)),
                          std::sqrt(covariance(kSlowLag, kSlowLag))};
    fit.set_ups = set_ups_of(survey);
    return fit;
}

}  // namespace a351::corrector::whole_day
