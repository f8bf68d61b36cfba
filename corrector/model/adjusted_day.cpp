#include "corrector/model/adjusted_day.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "corrector/archive_series/on_all_cores.hpp"
#include "corrector/whole_day/day_regression.hpp"

namespace a351::corrector::model {
namespace {

/// Returns the effective degrees of freedom of a station's uncertainty (Welch and Satterthwaite).
std::optional<double> degrees_of_freedom(
    const whole_day::GravityEstimate& gravity,
    const std::optional<std::array<double, 3>>& noise_log_errors) {
    if (!noise_log_errors) return std::nullopt;
    double sum = 0.0;
    // Placement, flicker and white are the first sources of errors, too.
    for (std::size_t k = 0; k < noise_log_errors->size(); ++k)
        sum += std::pow(gravity.parts_mgal.at(k), 4) * 2.0 * std::pow(noise_log_errors->at(k), 2);
    return std::pow(gravity.standard_error, 4) / sum;
}

/// Returns the accepted rows of a station, or all if none is.
std::vector<std::size_t> members_of(const std::vector<CorrectedRow>& rows, const RowChoice& choice,
                                    const StationValue& station) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].row.site == station.site && (station.is_flagged_only || choice.accepted[i]))
            members.push_back(i);
    return members;
}

/// Returns the errors that a gravity has in common with those of other days.
SharedErrors shared_errors(const std::vector<CorrectedRow>& rows, const AdjustedDay& day,
                           const whole_day::GravityEstimate& gravity, std::size_t own,
                           bool is_calibrated) {
    SharedErrors shared{gravity.shared_mgal, is_calibrated, {}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const whole_day::DayStation& station = day.survey().stations[i];
        if (station.gravity && station.u_gravity.value() > 0.0 && station.number != own)
            shared.references_mgal[rows[i].row.site] = gravity.of_gravities_mgal[station.number];
    }
    return shared;
}

/// Sets what needs the reference of the station to be hidden; if it alone is held, only the errors
/// of its reference.
void set_left_out(StationValue& station, const std::vector<CorrectedRow>& rows,
                  const std::vector<std::size_t>& members, const AdjustedDay& day,
                  bool is_calibrated) {
    const std::size_t first = members.front();
    if (day.without(first) == nullptr) {
        const MilliGal u = rows[first].row.u_reference.value_or(MilliGal(0.0));
        station.shared = SharedErrors{{}, is_calibrated, {{station.site, u.value()}}};
        return;
    }
    double sum = 0.0, squares = 0.0;
    std::set<std::size_t> numbers;
    for (const std::size_t i : members) {
        sum += day.without(i)->adjustment->corrected(i).value();
        const std::size_t number = day.number_of(i);
        if (numbers.insert(number).second)
            squares += std::pow(day.without(i)->gravity.standard_error, 2);
    }
    station.left_out = MilliGal(sum / static_cast<double>(members.size()));
    station.u_gravity = MilliGal(std::sqrt(squares) / static_cast<double>(numbers.size()));
    station.u_left_out = station.u_gravity;
    if (numbers.size() != 1) return;
    const whole_day::GravityEstimate& gravity = day.without(first)->gravity;
    station.parts_mgal = gravity.parts_mgal;
    station.shared = shared_errors(rows, day, gravity, day.number_of(first), is_calibrated);
    station.dof = degrees_of_freedom(gravity, day.without(first)->adjustment->noise_log_errors());
    station.coverage_factor = kCoverageFactor;
}

void enlarge(std::optional<MilliGal>& u, double factor) {
    if (u) u = MilliGal(factor * u->value());
}

}  // namespace

AdjustedDay::AdjustedDay(whole_day::DaySurvey survey, const Adjustment& adjustment)
    : survey_(std::move(survey)), adjustment_(adjustment), fit_(adjustment->fit()) {
    without_.resize(adjustment->problem().gravity_count());
    for (std::size_t number = 0; number < without_.size(); ++number)
        if (adjustment->is_held(number)) ++held_count_;
    archive_series::on_all_cores(without_.size(), [&](std::size_t number) {
        Adjustment& own = without_[number].adjustment;
        own = adjustment;
        if (adjustment->is_held(number)) {
            if (!is_any_left_out()) return;  // without the only one, no station would be held
            whole_day::DaySurvey other = survey_;
            for (whole_day::DayStation& station : other.stations)
                if (station.number == number) station.gravity.reset();
            own = std::make_shared<const whole_day::DayAdjustment>(
                whole_day::adjust_day(std::move(other), &fit_.point).value());
        }
        without_[number].gravity = own->gravity(number);
    });
}

const AdjustedDay::Without* AdjustedDay::without(std::size_t row) const {
    const std::size_t number = number_of(row);
    return adjustment_->is_held(number) && !is_any_left_out() ? nullptr : &without_[number];
}

whole_day::DaySurvey day_survey(const SurveyProblem& problem, const RowChoice& choice,
                                const whole_day::DayPriors& priors) {
    whole_day::DaySurvey survey{problem.day, {}, priors};
    survey.temperature = problem.temperature;
    // A survey of another model has no record.
    if (!survey.temperature && problem.day != nullptr)
        survey.temperature = std::make_shared<const whole_day::LaggedMeans>(*problem.day);
    std::map<std::string, std::size_t> numbers;
    for (std::size_t i = 0; i < problem.rows.size(); ++i) {
        const reading::SurveyRow& row = problem.rows[i];
        const std::string name =
            choice.accepted[i] ? "station " + row.site : fmt::format("row {}", i);
        whole_day::DayStation station{std::nullopt,
                                      numbers.emplace(name, numbers.size()).first->second,
                                      row.u_reference.value_or(MilliGal(0.0))};
        if (station.u_gravity.value() < adjustment::kLeastSd_mgal) station.u_gravity = {};
        if (choice.in_use[i]) station.gravity = row.reference;
        station.steps = static_cast<std::size_t>(std::ranges::count_if(
            problem.options.steps,
            [&row](const adjustment::Step& step) { return step.is_before(row); }));
        survey.stations.push_back(station);
    }
    return survey;
}

AdjustedDay adjusted_day(const SurveyProblem& problem, const RowChoice& choice,
                         const whole_day::DayPriors& priors) {
    whole_day::DaySurvey survey = day_survey(problem, choice, priors);
    return {survey, std::make_shared<const whole_day::DayAdjustment>(
                        whole_day::adjust_day(survey, problem.nearby).value())};
}

std::vector<Coefficient> coefficients_of(const whole_day::DayFit& fit,
                                         std::optional<adjustment::Scope> scope) {
    std::vector<Coefficient> list;
    const auto add = [&](adjustment::Scope of, std::string name, double value,
                         std::optional<double> error) {
        if (!scope || *scope == of) list.push_back({std::move(name), value, error, std::nullopt});
    };
    using adjustment::Scope;
    for (std::size_t k = 0; k < whole_day::kDayTerms; ++k) {
        const adjustment::Term& term = *whole_day::kDayTermList.at(k);
        const whole_day::Estimate& estimate = fit.coefficients.at(k);
        const double without_effect = &term == &adjustment::kScaleTerm ? 1.0 : 0.0;
        add(term.scope, std::string(term.name), without_effect + estimate.value,
            estimate.standard_error);
    }
    for (std::size_t k = 0; k < fit.steps_mgal.size(); ++k)
        add(Scope::loop, fmt::format("step_{}_mgal", k + 1), fit.steps_mgal[k].value,
            fit.steps_mgal[k].standard_error);
    add(Scope::unit, "fast_lag_s", fit.fast_lag_s, fit.fast_lag_s * fit.lag_log_errors[0]);
    add(Scope::unit, "slow_lag_s", fit.slow_lag_s, fit.slow_lag_s * fit.lag_log_errors[1]);
    if (fit.outer) {
        for (std::size_t k = 0; k < fit.outer->mgal_per_degc.size(); ++k)
            add(Scope::unit, std::string(whole_day::kOuterNames.at(k)),
                fit.outer->mgal_per_degc.at(k).value,
                fit.outer->mgal_per_degc.at(k).standard_error);
        add(Scope::unit, std::string(whole_day::kOuterNames.back()), fit.outer->lag_s, {});
    }
    if (fit.scale_share)
        add(Scope::unit, "scale_share", fit.scale_share->value, fit.scale_share->standard_error);
    for (std::size_t k = 0; k < fit.on_scale.size(); ++k) {
        const auto place = static_cast<std::size_t>(whole_day::DayRegression::kOnScale.at(k));
        const adjustment::Term& term = *whole_day::kDayTermList.at(place);
        add(term.scope, "scale_" + std::string(term.name), fit.on_scale[k].value,
            fit.on_scale[k].standard_error);
    }
    const auto add_noise = [&](std::size_t place, std::string name, double mgal) {
        std::optional<double> error;
        if (fit.noise_log_errors) error = mgal * fit.noise_log_errors->at(place);
        add(Scope::loop, std::move(name), mgal, error);
    };
    add_noise(0, "placement_mgal", fit.noise.placement_mgal);
    add_noise(1, "flicker_mgal", fit.noise.flicker_mgal);
    add_noise(2, "white_mgal", fit.noise.white_mgal);
    return list;
}

void enlarge_uncertainties(Fit& result, double factor) {
    for (StationValue& station : result.stations) {
        enlarge(station.u_gravity, factor);
        enlarge(station.u_left_out, factor);
        if (!station.parts_mgal) continue;
        for (double& part : *station.parts_mgal) part *= factor;
        for (double& part : station.shared->unit_mgal) part *= factor;
        for (auto& [site, part] : station.shared->references_mgal) part *= factor;
    }
    for (StationDifference& difference : result.differences)
        difference.u = MilliGal(factor * difference.u.value());
    if (result.covariance) result.covariance->mgal2 *= factor * factor;
}

void set_day_stations(Fit& result, const SurveyProblem& problem, const RowChoice& choice,
                      const AdjustedDay& day) {
    const std::vector<CorrectedRow>& rows = result.rows;
    const bool is_calibrated = problem.options.calibration.has_value();
    std::vector<const StationValue*> compared;     // stations with an accepted row
    std::vector<std::size_t> numbers, first_rows;  // of these stations
    for (const std::string& site : station_names(problem.rows)) {
        StationValue station;
        station.site = site;
        station.is_flagged_only = true;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (rows[i].row.site != site) continue;
            if (!station.reference) station.reference = rows[i].row.reference;
            if (choice.accepted[i]) station.is_flagged_only = false;
        }
        const std::vector<std::size_t> members = members_of(rows, choice, station);
        double sum = 0.0;
        for (const std::size_t i : members) sum += rows[i].corrected.value();
        station.row_count = members.size();
        station.gravity = MilliGal(sum / static_cast<double>(members.size()));
        if (station.reference) station.residual = station.gravity - *station.reference;
        set_left_out(station, rows, members, day, is_calibrated);
        if (!station.is_flagged_only) {
            numbers.push_back(day.number_of(members.front()));
            first_rows.push_back(members.front());
        }
        result.stations.push_back(std::move(station));
    }
    for (const StationValue& station : result.stations)
        if (!station.is_flagged_only) compared.push_back(&station);

    for (std::size_t b = 0; b < compared.size(); ++b)
        for (std::size_t a = 0; a < b; ++a) {
            const whole_day::Estimate estimate =
                day.adjustment().difference(numbers[a], numbers[b]);
            result.differences.push_back(difference_of(*compared[a], *compared[b],
                                                       MilliGal(estimate.value),
                                                       MilliGal(estimate.standard_error)));
        }
    const Eigen::MatrixXd correlation = day.adjustment().correlation();
    StationCovariance covariance;
    Eigen::VectorXd u(std::ssize(compared));
    for (std::size_t k = 0; k < compared.size(); ++k) {
        covariance.sites.push_back(compared[k]->site);
        const MilliGal held = problem.rows[first_rows[k]].u_reference.value_or(MilliGal(0.0));
        u(static_cast<Eigen::Index>(k)) = compared[k]->u_left_out.value_or(held).value();
    }
    std::vector<Eigen::Index> places(numbers.begin(), numbers.end());
    covariance.mgal2 = u.asDiagonal() * correlation(places, places) * u.asDiagonal();
    result.covariance = std::move(covariance);
}

}  // namespace a351::corrector::model
