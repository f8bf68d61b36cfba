#include "corrector/model/joint_adjustment.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "corrector/model/calibration_use.hpp"
#include "corrector/model/day_fits.hpp"
#include "corrector/model/model.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::model {
namespace {

/// A reference that is held.
struct Reference {
    MilliGal gravity, u;

    [[nodiscard]] bool operator==(const Reference& other) const {
        return gravity.value() == other.gravity.value() && u.value() == other.u.value();
    }
};

/// Rows and stations of a survey.
struct Prepared {
    std::vector<reading::SurveyRow> rows;
    RowChoice choice;
    std::vector<whole_day::DayStation> stations;
};

Prepared prepared(const RecordedSurvey& survey) {
    Prepared result;
    for (const CorrectedRow& row : survey.result->rows) result.rows.push_back(row.row);
    const SurveyOptions& options = survey.result->options;
    result.choice = choose_rows(result.rows, options.datum, options.use_flags);
    result.stations = stations_of({result.rows, options, survey.day}, result.choice);
    return result;
}

/// Returns the references that a survey holds, by site; a site with two of them instead.
std::variant<std::map<std::string, Reference>, std::string> held_references(
    const std::vector<Prepared>& surveys) {
    std::map<std::string, Reference> held;
    for (const Prepared& survey : surveys)
        for (std::size_t i = 0; i < survey.rows.size(); ++i) {
            const whole_day::DayStation& station = survey.stations[i];
            if (!station.gravity) continue;
            const Reference reference{*station.gravity, station.u_gravity};
            const auto [place, is_new] = held.emplace(survey.rows[i].site, reference);
            if (!is_new && !(place->second == reference)) return survey.rows[i].site;
        }
    return held;
}

bool are_equal(const whole_day::DayPriors& a, const whole_day::DayPriors& b) {
    return a.mean == b.mean && a.factor == b.factor && a.bias_factor == b.bias_factor;
}

/// Returns the time of a record's bins.
std::pair<UtcTime, UtcTime> span_of(const reading::DayRecord& day) {
    return {day.bins.front().time, day.bins.back().time};
}

/// Returns why the surveys cannot be adjusted; empty if they can.
text::Message refusal_of(const std::vector<RecordedSurvey>& surveys) {
    for (const RecordedSurvey& survey : surveys)
        if (survey.day == nullptr || survey.result->as<WholeDayPart>() == nullptr)
            return text::message("{} is not corrected by the whole-day model", survey.name);
    for (std::size_t b = 0; b < surveys.size(); ++b)
        for (std::size_t a = 0; a < b; ++a) {
            if (surveys[a].serial_number != surveys[b].serial_number) continue;
            const auto of_a = span_of(*surveys[a].day), of_b = span_of(*surveys[b].day);
            if (of_a.first < of_b.second && of_b.first < of_a.second)
                return text::message("{} and {} are of one unit ({}) at the same time",
                                     surveys[a].name, surveys[b].name,
                                     surveys[a].serial_number.empty()
                                         ? text::message("no serial number in the metadata")
                                         : text::Message(surveys[a].serial_number));
        }
    return {};
}

/// Numbers of the stations in the adjustment.
class Numbers {
public:
    [[nodiscard]] std::size_t of(const std::string& site) {
        const auto [place, is_new] = numbers_.emplace(site, count_);
        if (is_new) {
            ++count_;
            sites_.emplace_back(place->second, site);
        }
        return place->second;
    }
    /// Returns the number of a row that is not accepted.
    [[nodiscard]] std::size_t of_row() { return count_++; }
    /// Returns numbers and names of the sites, in order.
    [[nodiscard]] const std::vector<std::pair<std::size_t, std::string>>& sites() const {
        return sites_;
    }

private:
    std::map<std::string, std::size_t> numbers_;
    std::vector<std::pair<std::size_t, std::string>> sites_;
    std::size_t count_ = 0;
};

/// Returns the survey as a part of the adjustment; its unit is not set.
whole_day::JointSurvey joint_survey(const RecordedSurvey& survey, Prepared& rows,
                                    const std::map<std::string, Reference>& held,
                                    Numbers& numbers) {
    whole_day::JointSurvey joint;
    joint.record = survey.day;
    joint.priors = day_priors_of(survey.result->options);
    for (std::size_t i = 0; i < rows.rows.size(); ++i) {
        whole_day::DayStation& station = rows.stations[i];
        const std::string& site = rows.rows[i].site;
        joint.gravities.resize(std::max(joint.gravities.size(), station.number + 1));
        if (!rows.choice.accepted[i]) {
            joint.gravities[station.number] = numbers.of_row();
            continue;
        }
        joint.gravities[station.number] = numbers.of(site);
        const auto reference = held.find(site);
        if (reference == held.end()) continue;
        station.gravity = reference->second.gravity;
        station.u_gravity = reference->second.u;
    }
    joint.stations = rows.stations;
    return joint;
}

Coefficient coefficient_of(std::string name, const whole_day::Estimate& estimate) {
    return {std::move(name), estimate.value, estimate.standard_error};
}

std::vector<Coefficient> terms_of(const whole_day::JointSurveyFit& fit, bool of_survey) {
    std::vector<Coefficient> list;
    for (std::size_t k = 0; k < whole_day::kDayTerms; ++k)
        if (whole_day::is_of_survey(static_cast<whole_day::DayTerm>(k)) == of_survey)
            list.push_back(coefficient_of(std::string(whole_day::kDayTermNames.at(k)),
                                          fit.coefficients.at(k)));
    return list;
}

JointTerms unit_terms(const RecordedSurvey& survey, const whole_day::JointSurveyFit& fit) {
    JointTerms unit{"", survey.serial_number, terms_of(fit, false)};
    for (Coefficient& one : unit.coefficients)
        if (one.name == "scale") one.value += 1.0;
    constexpr std::array<const char*, 2> kLagNames{"fast_lag_s", "slow_lag_s"};
    for (std::size_t k = 0; k < fit.lags_s.size(); ++k)
        unit.coefficients.push_back(
            {kLagNames.at(k), fit.lags_s.at(k), fit.lags_s.at(k) * fit.lag_log_errors.at(k)});
    if (fit.outer) {
        for (std::size_t k = 0; k < fit.outer->mgal_per_degc.size(); ++k)
            unit.coefficients.push_back(coefficient_of(std::string(whole_day::kOuterNames.at(k)),
                                                       fit.outer->mgal_per_degc.at(k)));
        unit.coefficients.push_back(
            {std::string(whole_day::kOuterNames.back()), fit.outer->lag_s, {}});
    }
    return unit;
}

JointTerms survey_terms(const RecordedSurvey& survey, const whole_day::JointSurveyFit& fit) {
    JointTerms terms{survey.name, survey.serial_number, terms_of(fit, true)};
    for (std::size_t k = 0; k < fit.steps_mgal.size(); ++k)
        terms.coefficients.push_back(
            coefficient_of(fmt::format("step_{}_mgal", k + 1), fit.steps_mgal[k]));
    terms.coefficients.push_back({"placement_mgal", fit.noise.placement_mgal, std::nullopt});
    terms.coefficients.push_back({"flicker_mgal", fit.noise.flicker_mgal, std::nullopt});
    terms.coefficients.push_back({"white_mgal", fit.noise.white_mgal, std::nullopt});
    return terms;
}

/// Returns the factor of JointAdjustment::uncertainty_factor.
double factor_of(const std::vector<RecordedSurvey>& surveys,
                 const std::vector<JointGravity>& stations,
                 const std::map<std::string, Reference>& held) {
    const bool has_misfit = std::ranges::any_of(surveys, [](const RecordedSurvey& survey) {
        return std::ranges::any_of(survey.result->as<WholeDayPart>()->fit_tests,
                                   [](const whole_day::FitTest& test) { return test.is_misfit(); });
    });
    double squares = 0.0, count = 0.0;
    for (const JointGravity& station : stations) {
        const auto reference = held.find(station.site);
        if (reference == held.end() || station.is_in_sample) continue;
        squares += std::pow((reference->second.gravity - station.gravity).value() /
                                std::hypot(station.u.value(), reference->second.u.value()),
                            2);
        count += 1.0;
    }
    return has_misfit && count > 0.0 ? std::max(1.0, std::sqrt(squares / count)) : 1.0;
}

/// Sets stations, differences and covariance.
void set_stations(JointAdjustment& result, const whole_day::JointFit& fit, const Numbers& numbers,
                  const std::map<std::string, Reference>& held,
                  const std::vector<RecordedSurvey>& surveys) {
    const Eigen::MatrixXd correlation = fit.system.correlation();
    std::vector<Eigen::Index> places;
    for (const auto& [number, site] : numbers.sites()) {
        const whole_day::Estimate gravity = fit.system.left_out(number);
        result.stations.push_back({site, MilliGal(gravity.value), MilliGal(gravity.standard_error),
                                   held.size() == 1 && held.contains(site)});
        result.covariance.sites.push_back(site);
        places.push_back(static_cast<Eigen::Index>(number));
    }
    result.uncertainty_factor = factor_of(surveys, result.stations, held);
    for (JointGravity& station : result.stations)
        station.u = MilliGal(result.uncertainty_factor * station.u.value());
    Eigen::VectorXd u(std::ssize(places));
    for (std::size_t k = 0; k < result.stations.size(); ++k)
        u(static_cast<Eigen::Index>(k)) = result.stations[k].u.value();
    result.covariance.mgal2 = u.asDiagonal() * correlation(places, places) * u.asDiagonal();
    for (std::size_t b = 0; b < places.size(); ++b)
        for (std::size_t a = 0; a < b; ++a) {
            const auto& [from, from_site] = numbers.sites()[a];
            const auto& [to, to_site] = numbers.sites()[b];
            const whole_day::Estimate estimate = fit.system.difference(from, to);
            StationDifference difference{
                from_site, to_site, MilliGal(estimate.value),
                MilliGal(result.uncertainty_factor * estimate.standard_error), std::nullopt};
            if (held.contains(from_site) && held.contains(to_site))
                difference.reference = held.at(to_site).gravity - held.at(from_site).gravity;
            result.differences.push_back(std::move(difference));
        }
}

}  // namespace

std::variant<JointAdjustment, text::Message> adjust_jointly(
    const std::vector<RecordedSurvey>& surveys) {
    if (text::Message refusal = refusal_of(surveys); !refusal.empty()) return refusal;
    std::vector<Prepared> rows;
    for (const RecordedSurvey& survey : surveys) rows.push_back(prepared(survey));
    const auto references = held_references(rows);
    if (const auto* const site = std::get_if<std::string>(&references))
        return text::message("the surveys have different references of {}", *site);
    const auto& held = std::get<std::map<std::string, Reference>>(references);

    Numbers numbers;
    std::vector<whole_day::JointSurvey> joint;
    std::vector<std::size_t> first_of_unit;
    for (std::size_t k = 0; k < surveys.size(); ++k) {
        joint.push_back(joint_survey(surveys[k], rows[k], held, numbers));
        const auto unit = std::ranges::find_if(first_of_unit, [&](std::size_t other) {
            return !surveys[k].serial_number.empty() &&
                   surveys[other].serial_number == surveys[k].serial_number &&
                   are_equal(joint[other].priors, joint[k].priors);
        });
        joint.back().unit = static_cast<std::size_t>(unit - first_of_unit.begin());
        if (unit == first_of_unit.end()) first_of_unit.push_back(k);
    }
    const whole_day::JointFit fit = whole_day::fit_jointly(joint);
    JointAdjustment result;
    set_stations(result, fit, numbers, held, surveys);
    for (const std::size_t k : first_of_unit)
        result.units.push_back(unit_terms(surveys[k], fit.surveys[k]));
    for (std::size_t k = 0; k < surveys.size(); ++k)
        result.surveys.push_back(survey_terms(surveys[k], fit.surveys[k]));
    result.share = fit.share;
    return result;
}

}  // namespace a351::corrector::model
