#include "corrector/series/placement_series.hpp"

#include <fmt/core.h>

#include <cmath>

#include "corrector/model/calibration_use.hpp"
#include "corrector/series/series_rows.hpp"
#include "corrector/whole_day/day_model.hpp"
#include "protocol/core/units.hpp"
#include "protocol/signal/distributions.hpp"

namespace a351::corrector::series {
namespace {

// Eight set-ups give the placement within a factor of 1.7 (95 %), twenty within 1.4.
constexpr std::size_t kFewestPlacements = 8;
// Largest error of ln(placement): that of the prior alone is 0.69.
constexpr double kGreatestLogError = 0.5;

unit::Placement with_limits(double mgal, double log_error) {
    const double factor = std::exp(signal::kNormal95 * log_error);
    return {mgal, mgal / factor, mgal * factor};
}

}  // namespace

PlacementSeries measure_placement(const reading::OccupationRows& read,
                                  const unit::Calibration& known, const std::string& origin) {
    PlacementSeries series;
    const CheckedSeries checked{"placement", origin, read};
    series.set_ups = checked.set_ups();
    checked.require_one_point();
    if (series.set_ups < kFewestPlacements)
        checked.refuse(fmt::format("{} set-ups", series.set_ups),
                       fmt::format("{} or more, about 20 are good", kFewestPlacements));
    checked.require_day();
    // Gravity only shifts the constant.
    whole_day::DaySurvey day{&*read.day, checked.stations(), model::day_priors_of(known)};
    const whole_day::DayFit fit = whole_day::adjust_day(std::move(day)).value().fit();
    if (!fit.noise_log_errors || fit.noise_log_errors->front() > kGreatestLogError)
        checked.refuse("the set-ups do not determine it", "more set-ups, or a quieter place");
    series.noise = fit.noise;
    series.placement = with_limits(fit.noise.placement_mgal, fit.noise_log_errors->front());
    return series;
}

unit::Placement combine(const std::vector<PlacementSeries>& series) {
    const whole_day::LogNormalPrior prior = whole_day::kUsualPlacement_mgal;
    const double prior_information = 1.0 / std::pow(std::log(prior.factor), 2);
    if (series.size() == 1) return series.front().placement;
    double information = prior_information, weighted = prior_information * std::log(prior.median);
    for (const PlacementSeries& one : series) {
        const double own = 1.0 / std::pow(one.placement.log_error(), 2);
        information += own - prior_information;
        weighted += own * std::log(one.placement.mgal) - prior_information * std::log(prior.median);
    }
    return with_limits(std::exp(weighted / information), 1.0 / std::sqrt(information));
}

}  // namespace a351::corrector::series
