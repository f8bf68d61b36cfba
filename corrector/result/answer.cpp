#include "corrector/result/answer.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "corrector/judgement/reading_name.hpp"
#include "corrector/judgement/survey_findings.hpp"
#include "corrector/result/columns.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::result {
namespace {

using judgement::Grade;
using judgement::ReadingGrade;
using text::tr;

std::string grade_in_words(Grade grade) { return text::translated(judgement::grade_name(grade)); }

/// Coverage factor for 95 % of five degrees of freedom.  With one it is 12.7, and u can be a tenth
/// of the error.
constexpr double kMostCoverage = 2.58;

/// Returns the uncertainty to be shown: that from the scatter if it is larger than stated.
std::optional<MilliGal> shown_u(const model::SurveyCorrection& result,
                                const model::StationValue& station) {
    return judgement::scatters_more_than_stated(result) && station.u_a_posteriori
               ? station.u_a_posteriori
               : station.u_gravity;
}

/// Returns u of the stations in ascending order.
/// @param with_held  also of those that a network holds, which is that of their references.
std::vector<double> uncertainties(const model::SurveyCorrection& result, bool with_held) {
    const auto* const network = result.as<model::NetworkPart>();
    std::vector<double> values;
    for (const model::StationValue& station : result.stations)
        if (const auto u = shown_u(result, station);
            u && (with_held || network == nullptr || !network->holds(station.site)))
            values.push_back(u->value());
    std::ranges::sort(values);
    return values;
}

/// Returns false if u comes from fewer than five degrees of freedom.
bool is_u_known(const model::SurveyCorrection& result) {
    constexpr std::size_t kFewestDof = 5;
    const auto* const network = result.as<model::NetworkPart>();
    if (network != nullptr)
        return !judgement::scatters_more_than_stated(result) || network->dof >= kFewestDof;
    return std::ranges::none_of(result.stations, [](const model::StationValue& station) {
        return station.coverage_factor > kMostCoverage;
    });
}

std::string counted_stations(const model::SurveyCorrection& result) {
    const std::size_t count = result.stations.size();
    return count == 1 ? tr("One station") : tr("{} stations", count);
}

bool is_left_out(const model::StationValue& station) {
    return station.left_out && station.reference;
}

std::string accuracy(const model::SurveyCorrection& result) {
    const std::string stations = counted_stations(result);
    const std::vector<double> errors_mgal = judgement::new_station_errors_mgal(result);
    const std::size_t left_out = errors_mgal.size();
    const double rms_mgal = model::root_mean_square(errors_mgal).value_or(0.0);
    const std::string error = text::fixed(rms_mgal, text::decimals_for(rms_mgal));
    if (left_out >= judgement::kFewestLeftOut)
        return tr("{}; a new one is known to +- {} mGal (each known station left out).", stations,
                  error);
    const std::vector<double> u = uncertainties(result, false);
    if (u.empty() || !is_u_known(result))
        return tr("{}; this model and these readings do not show how well a new one is known.",
                  stations);
    const int decimals = decimals_of(result);
    const std::string least = text::fixed(u.front(), decimals),
                      most = text::fixed(u.back(), decimals);
    return left_out > 0
               ? tr("{}; u is {} to {} mGal. Only {} known stations could be left out to test it: "
                    "they are off by {} mGal rms.",
                    stations, least, most, left_out, error)
               : tr("{}; u is {} to {} mGal, not tested: no known station can be left out.",
                    stations, least, most);
}

/// Returns the difference from the reference that the first table shows.
Column<model::StationValue> difference_column(const model::SurveyCorrection& result) {
    const bool is_any_left_out = std::ranges::any_of(result.stations, is_left_out);
    const auto difference = [is_any_left_out](const model::StationValue& station) {
        const auto& value = is_any_left_out ? station.left_out : std::optional(station.gravity);
        return value && station.reference ? cell(*value - *station.reference) : Cell();
    };
    return {"difference_mgal",
            difference,
            {is_any_left_out ? text::marked("Measured - reference, left out")
                             : text::marked("Gravity - reference, in sample")}};
}

/// Returns the grades without a doubt about the survey as a whole, which is a finding or a note.
std::vector<ReadingGrade> own_grades(std::vector<ReadingGrade> grades) {
    for (ReadingGrade& one : grades) {
        std::erase_if(one.reasons, [](const judgement::Reason& reason) {
            return reason.code == judgement::kOfWholeSurvey;
        });
        if (one.reasons.empty()) one.grade = Grade::trust;
    }
    return grades;
}

}  // namespace

int decimals_of(const model::SurveyCorrection& result) {
    const std::vector<double> u = uncertainties(result, true);
    return text::decimals_for(u.empty() ? std::nullopt : std::optional(u[u.size() / 2]));
}

int decimals_of(const model::Coefficient& coefficient) {
    constexpr int kWithoutError = 4;
    return coefficient.standard_error ? text::decimals_for(coefficient.standard_error)
                                      : kWithoutError;
}

std::string answer(const model::SurveyCorrection& result,
                   const std::vector<ReadingGrade>& all_grades) {
    const std::vector<ReadingGrade> grades = own_grades(all_grades);
    const bool is_unusable = std::ranges::count(result.findings, reading::FindingKind::unusable_day,
                                                &reading::Finding::kind) > 0;
    std::string text =
        is_unusable ? tr("{}, but this day cannot be used as it is.", counted_stations(result))
                    : accuracy(result);
    const bool has_findings = !std::ranges::all_of(result.findings, reading::is_remark);
    if (has_findings) text += ' ' + tr("First look at what was found (below).");
    if (is_unusable || std::ranges::any_of(result.findings, [](const reading::Finding& finding) {
            return !reading::is_remark(finding) && !finding.amendment.empty();
        }))
        return text;
    std::vector<std::string> urgent, optional;
    const auto has_other = [&](const std::string& site) {
        return judgement::grade_of_station(result, grades, site).grade == Grade::trust;
    };
    for (const reading::LeftOut& stay : result.left_out)
        if (!has_other(stay.site)) urgent.push_back(reading::stay_name(stay.site, stay.occupation));
    for (std::size_t i = 0; i < grades.size(); ++i) {
        if (grades[i].grade != Grade::repeat) continue;
        (has_other(result.rows[i].row.site) ? optional : urgent)
            .push_back(judgement::reading_name(result.rows, i));
    }
    if (!urgent.empty()) text += ' ' + tr("Repeat: {}.", text::joined(urgent));
    if (!optional.empty())
        text += ' ' + tr("If there is time, repeat: {}.", text::joined(optional));
    if (!has_findings && urgent.empty() && optional.empty() &&
        !judgement::scatters_more_than_stated(result))
        text += ' ' + tr("Nothing to repeat.");
    return text;
}

Table answer_table(const model::SurveyCorrection& result, const std::vector<ReadingGrade>& grades) {
    using Row = model::StationValue;
    std::vector<Column<Row>> columns =
        with_keys(station_columns(result.stations), {"site", "n", "gravity_mgal"});
    const bool is_known = is_u_known(result);
    const auto u = [&](const Row& station) {
        return is_known ? cell(shown_u(result, station)) : Cell();
    };
    columns.push_back(
        {"u_mgal",
         u,
         {judgement::scatters_more_than_stated(result) ? text::marked("u mGal, a posteriori")
                                                       : text::marked("u mGal")}});
    columns.push_back(difference_column(result));
    columns = with_decimals(columns, decimals_of(result));
    const auto mark = [&](const Row& station) {
        return grade_in_words(judgement::grade_of_station(result, grades, station.site).grade);
    };
    columns.push_back({"mark", mark, {text::marked("Mark"), 0, 'l'}});
    return table_of(columns, result.stations);
}

std::vector<std::string> notes(const model::SurveyCorrection& result,
                               const std::vector<ReadingGrade>& all_grades) {
    const std::vector<ReadingGrade> grades = own_grades(all_grades);
    std::vector<std::string> list;
    std::map<std::string, std::vector<std::string>> without_value;
    for (const reading::LeftOut& stay : result.left_out)
        without_value[stay.reason].push_back(reading::stay_name(stay.site, stay.occupation));
    for (const auto& [reason, names] : without_value)
        list.push_back(tr("{}: no value ({}).", text::joined(names), reason));
    const auto is_found = [&](const ReadingGrade& one) {
        return std::ranges::any_of(one.reasons, [&](const judgement::Reason& reason) {
            return std::ranges::count(result.findings, reason.text, &reading::Finding::text) > 0;
        });
    };
    for (const Grade grade : {Grade::repeat, Grade::care})
        for (std::size_t i = 0; i < grades.size(); ++i)
            if (grades[i].grade == grade && !is_found(grades[i]))
                list.push_back(tr("{}, {}: {}.", judgement::reading_name(result.rows, i),
                                  grade_in_words(grade), judgement::reason_in_words(grades[i])));
    if (judgement::scatters_more_than_stated(result))
        list.push_back(
            tr("The readings scatter more than stated (global test failed): look for a fault."));
    constexpr double kMuchLess = 0.1;  // No cautious user states ten times the scatter.
    if (const auto* const network = result.as<model::NetworkPart>();
        network != nullptr && network->scatters_less_than_stated() &&
        network->s0().value_or(1.0) < kMuchLess)
        list.push_back(
            tr("The readings scatter ten times less than stated, or still less: are sd_mgal and "
               "reading_sd_mgal in mGal?"));
    std::vector<std::string> unchecked;
    for (const model::StationValue& station : result.stations)
        if (station.row_count == 1 && !station.reference) unchecked.push_back(station.site);
    if (!unchecked.empty())
        list.push_back(tr("One reading and no reference, so nothing checks them: {}.",
                          text::joined(unchecked)));
    return list;
}

}  // namespace a351::corrector::result
