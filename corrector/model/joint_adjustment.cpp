#include "corrector/model/joint_adjustment.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "corrector/adjustment/helmert_block.hpp"
#include "corrector/model/adjusted_day.hpp"
#include "corrector/model/calibration_use.hpp"
#include "corrector/model/model.hpp"

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
    whole_day::DaySurvey day;  ///< With white noise only its stations are used.
    std::optional<adjustment::HelmertBlock> block;  ///< Absent for the whole-day model.
    std::vector<std::string> sites_of_block;
    bool has_prior = false;  ///< A term of the block has a prior.
};

/// Prepares a survey.
/// @return why it cannot take part; empty if it can.
text::Message prepare(Prepared& result, const RecordedSurvey& survey) {
    for (const CorrectedRow& row : survey.result->rows) result.rows.push_back(row.row);
    const SurveyOptions& options = survey.result->options;
    result.choice = choose_rows(result.rows, options.datum, options.use_flags);
    result.day =
        day_survey({result.rows, options, survey.day}, result.choice, day_priors_of(options));
    if (survey.result->as<WholeDayPart>() != nullptr) return {};
    const Model& model = *find_model(survey.result->model);
    if (!model.joint)
        return text::message("{} is corrected by {}, which is no adjustment", survey.name,
                             model.name);
    result.rows = without_known_tilt(std::move(result.rows), options.calibration);
    const auto adjusted = model.joint({result.rows, options, nullptr}, result.choice);
    if (adjusted) result.block = adjustment::helmert_block(*adjusted);
    if (!result.block)
        return text::message("{} has too few readings at known stations for the noise of {}",
                             survey.name, model.name);
    for (const adjustment::EquationStation& station : adjusted->survey.stations())
        result.sites_of_block.push_back(station.site);
    result.has_prior = std::ranges::any_of(
        adjusted->survey.terms(),
        [](const adjustment::SurveyTerm& term) { return term.prior.has_value(); });
    return {};
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
    return a.mean == b.mean && a.factor == b.factor && a.bias_factor == b.bias_factor &&
           a.scale_share == b.scale_share;
}

/// Returns the time of the readings.
std::pair<UtcTime, UtcTime> span_of(const RecordedSurvey& survey) {
    return {survey.result->rows.front().row.time, survey.result->rows.back().row.time};
}

/// Returns two surveys of one unit at the same time, in words; empty if there are none.
text::Message same_time_of(const std::vector<RecordedSurvey>& surveys) {
    for (std::size_t b = 0; b < surveys.size(); ++b)
        for (std::size_t a = 0; a < b; ++a) {
            if (surveys[a].serial_number != surveys[b].serial_number) continue;
            const auto of_a = span_of(surveys[a]), of_b = span_of(surveys[b]);
            if (of_a.first <= of_b.second && of_b.first <= of_a.second)
                return text::message("{} and {} are of one unit ({}) at the same time",
                                     surveys[a].name, surveys[b].name,
                                     surveys[a].serial_number.empty()
                                         ? text::message("no serial number in the metadata")
                                         : text::Message(surveys[a].serial_number));
        }
    return {};
}

/// Returns a survey whose prior would count again for each survey of its unit, in words; empty if there
/// is none.
text::Message prior_again_of(const std::vector<RecordedSurvey>& surveys,
                             const std::vector<Prepared>& prepared) {
    for (std::size_t k = 0; k < surveys.size(); ++k)
        if (prepared[k].has_prior && !surveys[k].serial_number.empty() &&
            std::ranges::count(surveys, surveys[k].serial_number, &RecordedSurvey::serial_number) >
                1)
            return text::message("the prior of {} would count again for each day of its unit",
                                 surveys[k].name);
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

/// Holds the reference of a site, if any survey holds it.
void hold(whole_day::DayStation& station, const std::string& site,
          const std::map<std::string, Reference>& held) {
    const auto reference = held.find(site);
    if (reference == held.end()) return;
    station.gravity = reference->second.gravity;
    station.u_gravity = reference->second.u;
}

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
        hold(station, site, held);
    }
}

/// Returns a survey with white noise, joined like the others.
whole_day::WhiteSurvey white_survey(const Prepared& survey,
                                    const std::map<std::string, Reference>& held,
                                    Numbers& numbers) {
    whole_day::WhiteSurvey result{*survey.block, {}};
    for (const std::string& site : survey.sites_of_block) {
        whole_day::DayStation& station = result.stations.emplace_back();
        station.number = numbers.of(site);
        hold(station, site, held);
    }
    return result;
}

/// Returns true if a test says that the model does not fit the readings.
bool is_misfit(const Fit& fit) {
    if (const auto* const network = fit.as<NetworkPart>())
        return network->scatters_more_than_stated();
    const auto* const day = fit.as<WholeDayPart>();
    return day != nullptr &&
           std::ranges::any_of(day->fit_tests,
                               [](const whole_day::FitTest& test) { return test.is_misfit(); });
}

/// Returns the factor of JointAdjustment::uncertainty_factor.
double factor_of(const std::vector<RecordedSurvey>& surveys,
                 const std::vector<JointGravity>& stations,
                 const std::map<std::string, Reference>& held) {
    const bool has_misfit = std::ranges::any_of(
        surveys, [](const RecordedSurvey& survey) { return is_misfit(*survey.result); });
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
    std::vector<Prepared> prepared(surveys.size());
    for (std::size_t k = 0; k < surveys.size(); ++k)
        if (text::Message refusal = prepare(prepared[k], surveys[k]); !refusal.empty())
            return refusal;
    if (text::Message refusal = same_time_of(surveys); !refusal.empty()) return refusal;
    if (text::Message refusal = prior_again_of(surveys, prepared); !refusal.empty()) return refusal;
    const auto references = held_references(prepared);
    if (const auto* const site = std::get_if<std::string>(&references))
        return text::message(
            "the surveys have different references of {}, or different uncertainties of it", *site);
    const auto& held = std::get<std::map<std::string, Reference>>(references);

    Numbers numbers;
    std::vector<whole_day::DaySurvey> days;
    std::vector<whole_day::WhiteSurvey> white;
    std::vector<std::size_t> of_day, first_of_unit;  // numbers of surveys
    for (std::size_t k = 0; k < surveys.size(); ++k) {
        if (prepared[k].block) {
            white.push_back(white_survey(prepared[k], held, numbers));
            continue;
        }
        join(prepared[k], held, numbers);
        const auto unit = std::ranges::find_if(first_of_unit, [&](std::size_t other) {
            return !surveys[k].serial_number.empty() &&
                   surveys[other].serial_number == surveys[k].serial_number &&
                   are_equal(prepared[other].day.priors, prepared[k].day.priors);
        });
        prepared[k].day.unit = static_cast<std::size_t>(unit - first_of_unit.begin());
        if (unit == first_of_unit.end()) first_of_unit.push_back(k);
        days.push_back(prepared[k].day);
        of_day.push_back(k);
    }
    const whole_day::DayAdjustment adjusted = whole_day::adjust_days(days, white);
    JointAdjustment result;
    set_stations(result, adjusted, numbers, held, surveys);
    result.units.resize(first_of_unit.size());
    for (const RecordedSurvey& survey : surveys)
        result.surveys.push_back({survey.name, survey.result->model, survey.serial_number, {}});
    for (std::size_t k = 0; k < days.size(); ++k) {
        const whole_day::DayFit fit = adjusted.fit(k);
        using adjustment::Scope;
        JointTerms& survey = result.surveys[of_day[k]];
        survey.coefficients = coefficients_of(fit, Scope::loop);
        // A day with the temperature of an outer oven says more of the unit.
        JointTerms& unit = result.units[days[k].unit];
        std::vector<Coefficient> of_unit = coefficients_of(fit, Scope::unit);
        if (of_unit.size() > unit.coefficients.size())
            unit = {"", "", survey.serial_number, std::move(of_unit)};
    }
    result.share = adjusted.share();
    return result;
}

}  // namespace a351::corrector::model
