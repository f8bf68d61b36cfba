#include "corrector/report/summary.hpp"

#include <cmath>
#include <sstream>

#include "corrector/judgement/reading_grade.hpp"
#include "corrector/report/html.hpp"
#include "corrector/result/answer.hpp"
#include "corrector/result/scale_report.hpp"
#include "corrector/result/table_text.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::report {

using text::tr;

namespace {

/// Adds the findings as a numbered list, headlines in bold: the mistakes, or the remarks.
void add_findings(pugi::xml_node parent, const std::vector<reading::Finding>& findings,
                  bool are_remarks) {
    pugi::xml_node list;
    for (std::size_t k = 0; k < findings.size(); ++k) {
        const reading::Finding& finding = findings[k];
        if (reading::is_remark(finding) != are_remarks) continue;
        if (!list) {
            list = add_part(parent, "ol");
            list.append_attribute("start") = static_cast<unsigned>(k + 1);
        }
        const pugi::xml_node item = add_part(list, "li");
        if (finding.is_headline)
            add(item, "b", text::in_words(finding.text));
        else
            add_text(item, text::in_words(finding.text));
    }
}

/// Adds the amendments that the findings propose.
void add_amendments(pugi::xml_node parent, const std::vector<reading::Finding>& findings) {
    std::string amendments;
    for (const reading::Finding& finding : findings) amendments += finding.amendment;
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
                    result.score.parameter_count, network->station_count,
                    network->held_sites.size(), result.score.dof);
}

}  // namespace

std::optional<double> standard_error_of_rms(const model::Score& score) {
    if (!score.rms_mgal || score.dof == 0) return std::nullopt;
    return *score.rms_mgal / std::sqrt(2.0 * static_cast<double>(score.dof));
}

std::string scatter_sentence(const model::Score& score) {
    const auto error = standard_error_of_rms(score);
    return error
               ? tr("The RMS of the residuals (n = {}) has itself a standard error of {} mGal, RMS "
                    "/ sqrt(2 dof) with {} degrees of freedom. Smaller differences between "
                    "models are not significant.",
                    score.row_count, text::fixed(*error, 2), score.dof)
               : tr("No degree of freedom is left in the fit, so the residuals say nothing about "
                    "accuracy.");
}

void add_answer(pugi::xml_node parent, const model::SurveyCorrection& result,
                const std::vector<std::string>& missing) {
    std::string answer = result::answer(result, judgement::grade_readings(result));
    if (const auto at = answer.find("+-"); at != std::string::npos) answer.replace(at, 2, "\u00B1");
    add(parent, "p", answer).append_attribute("class") = "answer";
    add_findings(parent, result.findings, false);
    add_list(parent, missing);
}

void add_answer_table(pugi::xml_node parent, const model::SurveyCorrection& result) {
    add_table(parent,
              tr("Gravity with its standard uncertainty u. Differences from a reference are "
                 "measured minus reference, here and in all tables and figures; left out: the "
                 "value of the station was found without its own reference. Mark: trust, care "
                 "(look at the reason) or repeat."),
              result::answer_table(result, judgement::grade_readings(result)));
}

void add_notes(pugi::xml_node parent, const model::SurveyCorrection& result,
               std::size_t warning_count) {
    std::vector<std::string> notes = result::notes(result, judgement::grade_readings(result));
    if (warning_count > 0)
        notes.push_back(tr("Remarks and warnings: {}, see the last section.", warning_count));
    add_list(parent, notes);
    add_findings(parent, result.findings, true);
    add_amendments(parent, result.findings);
}

void add_accuracy(pugi::xml_node parent, const model::SurveyCorrection& result) {
    add(parent, "p", headline(result));
    std::vector<std::string> sentences = result::scale_sentences(result);
    sentences.insert(sentences.begin(), scatter_sentence(result.score));
    add_list(parent, sentences);
}

}  // namespace a351::corrector::report
