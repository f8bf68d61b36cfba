#include "corrector/report/summary.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "corrector/judgement/reading_name.hpp"
#include "corrector/model/model.hpp"
#include "corrector/model/linear_models.hpp"
#include "corrector/report/html.hpp"
#include "corrector/result/scale_report.hpp"
#include "corrector/result/table_text.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::report {

using judgement::Grade;
using judgement::ReadingGrade;
using text::tr;

namespace {

/// Returns the occupations without a value for each reason, in order of time.
std::vector<std::pair<std::string, std::vector<std::string>>> left_out_by_reason(
    const model::SurveyCorrection& result) {
    std::vector<std::pair<std::string, std::vector<std::string>>> reasons;
    for (const reading::LeftOut& stay : result.left_out) {
        auto known = std::ranges::find_if(
            reasons, [&](const auto& entry) { return entry.first == stay.reason; });
        if (known == reasons.end()) known = reasons.insert(known, {stay.reason, {}});
        known->second.push_back(fmt::format("{} ({})", stay.site, stay.occupation));
    }
    return reasons;
}

/// Adds the table of readings with reasons, the doubtful ones first.
void add_reasons(pugi::xml_node parent, const model::SurveyCorrection& result,
                 const std::vector<ReadingGrade>& grades) {
    const bool is_day = result.as<model::WholeDayPart>() != nullptr;
    std::vector<HtmlCells> rows;
    for (const Grade wanted : {Grade::repeat, Grade::care, Grade::trust}) {
        for (std::size_t i = 0; i < grades.size(); ++i) {
            if (grades[i].grade != wanted || grades[i].reasons.empty()) continue;
            rows.push_back(
                {judgement::reading_name(result.rows, i),
                 std::string(text::translated(judgement::grade_name(wanted), text::language())),
                 text::fixed_or(judgement::error_of(result.rows[i]), 2, "-"),
                 text::fixed_or(result.rows[i].u_corrected, 2, "-"),
                 judgement::reason_in_words(grades[i])});
        }
    }
    if (rows.empty()) return;
    add_table(parent,
              is_day
                  ? tr("Readings with remarks. Error: reference minus value if the station is left "
                       "out (cross-validated); u: standard uncertainty of this value.")
                  : tr("Readings with remarks. Error: residual, reference minus corrected (in "
                       "sample); u: standard uncertainty."),
              "nnrrl", {tr("Reading"), tr("Grade"), tr("Error mGal"), "u mGal", tr("Why")}, rows);
}

void add_scores(pugi::xml_node parent, const model::SurveyCorrection& result) {
    const model::Score& score = result.score;
    std::vector<HtmlCells> rows;
    const auto add = [&rows](const std::string& quantity, const std::optional<double>& value,
                             const std::string& error, const std::string& kind) {
        if (value) rows.push_back({quantity, text::fixed(*value, 3), error, kind});
    };
    add(tr("RMS of the residuals"), score.rms_mgal,
        text::fixed_or(standard_error_of_rms(score), 2, "-"), tr("in sample"));
    add(tr("s, with the degrees of freedom ({}) for divisor", score.dof), score.s_mgal, "",
        tr("in sample"));
    add(tr("RMS error of a reading left out"), score.loo_mgal, "",
        tr("cross-validated (leave-one-out)"));
    add(tr("RMS error of a station left out"), score.loso_mgal, "",
        tr("cross-validated (leave-one-station-out)"));
    add(tr("the same, with the model chosen again each time"), result.choice_loso_mgal, "",
        tr("cross-validated (leave-one-station-out)"));
    add_table(
        parent,
        tr("Errors of the model. In sample: the fit has seen the references; cross-validated: it "
           "has not."),
        "lrrl", {tr("Quantity"), "mGal", tr("its standard error"), tr("Kind")}, rows);
}

bool is_unusable(const model::SurveyCorrection& result) {
    return std::ranges::count(result.findings, reading::FindingKind::unusable_day,
                              &reading::Finding::kind) > 0;
}

std::string headline(const model::SurveyCorrection& result) {
    const auto* const network = result.as<model::NetworkPart>();
    const std::string day =
        tr("{} to {}. Readings: {}. Stations: {}, base {}. Model {}{}; readings in the fit: {}.",
           to_rfc3339(result.rows.front().row.time), to_rfc3339(result.rows.back().row.time),
           result.rows.size(), result.stations.size(), result.options.base, result.model,
           result::choice_text(result), result.score.row_count);
    if (network == nullptr)
        return day + tr(" Coefficients: {}, degrees of freedom: {}.", result.score.parameter_count,
                        result.score.dof);
    return day + tr(" Unknowns: {}, of which stations: {} ({} held); degrees of freedom: {}.",
                    result.score.parameter_count, network->station_count, network->held_sites.size(),
                    result.score.dof);
}

}  // namespace

std::vector<std::string> actions(const model::SurveyCorrection& result,
                                 const std::vector<ReadingGrade>& grades) {
    std::vector<std::string> urgent, optional, care, trusted;
    for (std::size_t i = 0; i < grades.size(); ++i) {
        const std::string name = judgement::reading_name(result.rows, i);
        if (grades[i].grade == Grade::trust) {
            trusted.push_back(name);
        } else if (grades[i].grade == Grade::care) {
            care.push_back(name);
        } else if (judgement::grade_of_station(result, grades, result.rows[i].row.site).grade ==
                   Grade::trust) {
            optional.push_back(name);
        } else {
            urgent.push_back(name);
        }
    }
    std::vector<std::string> list;
    const auto add = [&list](const std::string& what, const std::vector<std::string>& names) {
        if (!names.empty()) list.push_back(tr("{}: {}.", what, text::joined(names)));
    };
    for (const auto& [reason, names] : left_out_by_reason(result))
        add(tr("Repeat, without a value ({})", reason), names);
    add(tr("Repeat, the station has no other reading to trust"), urgent);
    add(tr("Repeat if there is time, the station has another reading to trust"), optional);
    if (list.empty() && std::ranges::none_of(result.findings, &reading::Finding::is_headline))
        list.emplace_back(tr("No reading needs to be repeated."));
    add(tr("Use with care"), care);
    add(tr("Trust"), trusted);
    return list;
}

std::vector<std::string> limits_of(const model::SurveyCorrection& result) {
    const auto base_count = static_cast<std::size_t>(
        std::ranges::count_if(result.rows, [&](const model::CorrectedRow& row) {
            return row.row.site == result.options.base && row.is_used;
        }));
    std::vector<std::string> limits;
    if (base_count < model::kFewestBaseStays) {
        limits.push_back(tr(
            "Readings of the base {} in the fit: {}; three readings spread over the day separate "
            "drift from a bad reading.",
            result.options.base, base_count));
    }
    std::size_t single_count = 0;
    std::vector<std::string> unchecked;
    for (const model::StationValue& station : result.stations) {
        if (station.row_count > 1) continue;
        ++single_count;
        if (!station.reference) unchecked.push_back(station.site);
    }
    if (single_count > 0) {
        limits.push_back(
            tr("{} of {} stations have only one reading: an error there can be seen only if the "
               "reference is known.",
               single_count, result.stations.size()));
    }
    if (!unchecked.empty()) {
        limits.push_back(tr("One reading and no reference, so nothing checks them: {}.",
                            text::joined(unchecked)));
    }
    return limits;
}

std::optional<double> standard_error_of_rms(const model::Score& score) {
    if (!score.rms_mgal || score.dof == 0) return std::nullopt;
    return *score.rms_mgal / std::sqrt(2.0 * static_cast<double>(score.dof));
}

std::string scatter_sentence(const model::Score& score) {
    const bool has_priors = score.model == model::kWholeDay || score.model == model::kNetwork;
    if (has_priors && !score.loso_mgal)
        return tr(
            "n = {}: no known station can be left out as a test, because no other reference would "
            "remain. For a new station quote its u, which includes what is not known of the "
            "instrument.",
            score.row_count);
    const auto error = standard_error_of_rms(score);
    const std::string scatter =
        error ? tr("the scatter of {} mGal (in sample) has itself a standard error of about {} "
                   "mGal, RMS / sqrt(2 dof) with {} degrees of freedom. Smaller differences "
                   "between models are not significant.",
                   text::fixed(*score.rms_mgal, 2), text::fixed(*error, 2), score.dof)
              : tr("no degree of freedom is left in the fit, so the residuals say nothing about "
                   "accuracy.");
    const std::string quote =
        score.loso_mgal
            ? tr("{} mGal (cross-validated, leave-one-station-out).",
                 text::fixed(*score.loso_mgal, 2))
            : tr("the leave-one-station-out error; it cannot be computed for this model and these "
                 "readings.");
    return tr("n = {}: {} For a new station quote {}", score.row_count, scatter, quote);
}

void add_head(pugi::xml_node parent, const model::SurveyCorrection& result,
              const std::vector<std::string>& warnings, const std::vector<std::string>& missing) {
    add(parent, "p", headline(result));
    std::vector<std::string> remarks = missing;
    if (!warnings.empty())
        remarks.push_back(tr("Remarks and warnings: {}, see the last section.", warnings.size()));
    add_list(parent, remarks);
}

void add_findings(pugi::xml_node parent, const std::vector<reading::Finding>& findings) {
    const pugi::xml_node list = add_part(parent, "ol");
    std::string amendments;
    for (const reading::Finding& finding : findings) {
        if (finding.is_headline) {
            add(add_part(list, "li"), "b", text::in_words(finding.text));
        } else {
            add(list, "li", text::in_words(finding.text));
        }
        amendments += finding.amendment;
    }
    if (amendments.empty()) return;
    add(parent, "p",
        tr("To carry out the proposals: a351-correct amend SURVEY.toml --all, or paste into the "
           "amendments file what is right:"));
    pugi::xml_node block = add_part(parent, "pre");
    std::istringstream lines(amendments);
    for (std::string line; std::getline(lines, line);) {
        add_text(block, line);
        block.append_child(pugi::node_pcdata).set_value("\n");
    }
}

void add_actions(pugi::xml_node parent, const model::SurveyCorrection& result) {
    const std::vector<ReadingGrade> grades = judgement::grade_readings(result);
    add_list(parent, actions(result, grades));
    add_reasons(parent, result, grades);
}

void add_accuracy(pugi::xml_node parent, const model::SurveyCorrection& result) {
    add_scores(parent, result);
    add(parent, "p",
        is_unusable(result)
            ? tr("Correct the mistakes of this day before you use any of its values.")
            : scatter_sentence(result.score));
    add_list(parent, result::scale_sentences(result));
    const std::vector<std::string> limits = limits_of(result);
    if (!limits.empty()) add(parent, "h3", tr("Limits"));
    add_list(parent, limits);
}

}  // namespace a351::corrector::report
