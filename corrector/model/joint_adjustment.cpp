#include "corrector/model/joint_adjustment.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "corrector/model/adjusted_day.hpp"
#include "corrector/model/calibration_use.hpp"
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
    whole_day::DaySurvey day;
};

Prepared prepared(const RecordedSurvey& survey) {
    Prepared result;
    for (const CorrectedRow& row : survey.result->rows) result.rows.push_back(row.row);
    const SurveyOptions& options = survey.result->options;
    result.choice = choose_rows(result.rows, options.datum, options.use_flags);
    result.day =
        day_survey({result.rows, options, survey.day}, result.choice, day_priors_of(options));
    return result;
}

/// Returns the references that a survey holds, by site; a site with two of them instead.
std::variant<std::map<std::string, Reference>, std::string> held_references(
    const std::vector<Prepared>& surveys) {
    std::map<std::string, Reference> held;
    for (const Prepared& survey : surveys)
        for (std::size_t i = 0; i < survey.rows.size(); ++i) {
            const whole_day::DayStation& station = survey.day.stations[i];
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

/// Numbers the gravities of a survey, and holds what any survey holds.
void join(Prepared& survey, const std::map<std::string, Reference>& held, Numbers& numbers) {
    for (std::size_t i = 0; i < survey.rows.size(); ++i) {
        whole_day::DayStation& station = survey.day.stations[i];
        const std::string& site = survey.rows[i].site;
        std::vector<std::size_t>& gravities = survey.day.gravities;
        gravities.resize(std::max(gravities.size(), station.number + 1));
        if (!survey.choice.accepted[i]) {
            gravities[station.number] = numbers.of_row();
            continue;
        }
        gravities[station.number] = numbers.of(site);
        const auto reference = held.find(site);
        if (reference == held.end()) continue;
        station.gravity = reference->second.gravity;
        station.u_gravity = reference->second.u;
    }
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
void set_stations(JointAdjustment& result, const whole_day::DayAdjustment& fit,
                  const Numbers& numbers, const std::map<std::string, Reference>& held,
                  const std::vector<RecordedSurvey>& surveys) {
    const Eigen::MatrixXd correlation = fit.correlation();
    std::vector<Eigen::Index> places;
    for (const auto& [number, site] : numbers.sites()) {
        const whole_day::Estimate gravity = fit.left_out(number);
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
            const whole_day::Estimate estimate = fit.difference(from, to);
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
        return text::message(
            "the surveys have different references of {}, or different uncertainties of it", *site);
    const auto& held = std::get<std::map<std::string, Reference>>(references);

    Numbers numbers;
    std::vector<whole_day::DaySurvey> days;
    std::vector<std::size_t> first_of_unit;
    for (std::size_t k = 0; k < surveys.size(); ++k) {
        join(rows[k], held, numbers);
        days.push_back(rows[k].day);
        const auto unit = std::ranges::find_if(first_of_unit, [&](std::size_t other) {
            return !surveys[k].serial_number.empty() &&
                   surveys[other].serial_number == surveys[k].serial_number &&
                   are_equal(days[other].priors, days[k].priors);
        });
        days.back().unit = static_cast<std::size_t>(unit - first_of_unit.begin());
        if (unit == first_of_unit.end()) first_of_unit.push_back(k);
    }
    const whole_day::DayAdjustment adjusted = whole_day::adjust_days(days);
    JointAdjustment result;
    set_stations(result, adjusted, numbers, held, surveys);
    result.units.resize(first_of_unit.size());
    for (std::size_t k = 0; k < surveys.size(); ++k) {
        const whole_day::DayFit fit = adjusted.fit(k);
        using adjustment::Scope;
        result.surveys.push_back(
            {surveys[k].name, surveys[k].serial_number, coefficients_of(fit, Scope::loop)});
        // A day with the temperature of an outer oven says more of the unit.
        JointTerms& unit = result.units[days[k].unit];
        std::vector<Coefficient> of_unit = coefficients_of(fit, Scope::unit);
        if (of_unit.size() > unit.coefficients.size())
            unit = {"", surveys[k].serial_number, std::move(of_unit)};
    }
    result.share = adjusted.share();
    return result;
}

}  // namespace a351::corrector::model
