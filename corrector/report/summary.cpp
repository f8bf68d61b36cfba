#include "corrector/report/summary.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "corrector/figure/reading_name.hpp"
#include "corrector/report/html.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

std::string grade_text(Grade grade) {
    switch (grade) {
        case Grade::trust:
            return "trust";
        case Grade::care:
            return "with care";
        case Grade::repeat:
            return "repeat";
    }
    return {};
}

/// Returns the error of the value to which u belongs.  For the model day this is the value without
/// the reading's station.
std::optional<double> error_of(const CorrectedRow& row, bool is_day) {
    if (!row.residual) return std::nullopt;
    if (is_day && row.day && row.day->left_out)
        return (*row.row.reference - *row.day->left_out).value();
    return row.residual->value();
}

/// Returns the occupations without a value for each reason, in order of time.
std::vector<std::pair<std::string, std::vector<std::string>>> left_out_by_reason(
    const SurveyCorrection& result) {
    std::vector<std::pair<std::string, std::vector<std::string>>> reasons;
    for (const LeftOut& stay : result.left_out) {
        auto known = std::find_if(reasons.begin(), reasons.end(),
                                  [&](const auto& entry) { return entry.first == stay.reason; });
        if (known == reasons.end()) known = reasons.insert(known, {stay.reason, {}});
        known->second.push_back(stay.site + " (" + std::to_string(stay.occupation) + ')');
    }
    return reasons;
}

/// Returns the table of readings with reasons, the doubtful ones first.
std::string reading_table(const SurveyCorrection& result, const std::vector<ReadingGrade>& grades) {
    const bool is_day = result.model == "day";
    std::vector<HtmlCells> rows;
    for (const Grade grade : {Grade::repeat, Grade::care, Grade::trust}) {
        for (std::size_t i = 0; i < grades.size(); ++i) {
            if (grades[i].grade != grade || grades[i].reasons.empty()) continue;
            rows.push_back({reading_name(result.rows, i), grade_text(grade),
                            text::fixed_or(error_of(result.rows[i], is_day), 2, "-"),
                            text::fixed_or(result.rows[i].u_corrected, 2, "-"),
                            text::joined(grades[i].reasons, "; ")});
        }
    }
    if (rows.empty()) return {};
    return html_table("nnrrl",
                      {"Reading", "Verdict",
                       is_day ? "Error mGal (station left out)" : "Residual mGal", "u mGal", "Why"},
                      rows);
}

std::string accuracy_table(const SurveyCorrection& result) {
    const ModelScore& score = result.score;
    std::vector<HtmlCells> rows;
    const auto add = [&rows](const std::string& quantity, const std::optional<double>& value,
                             const std::string& error, const std::string& kind) {
        if (value) rows.push_back({quantity, text::fixed(*value, 3), error, kind});
    };
    add("RMS of the residuals", score.rms_mgal,
        text::fixed_or(standard_error_of_rms(score), 2, "-"), "in sample");
    add("s, with the degrees of freedom (" + std::to_string(score.dof) + ") for divisor",
        score.s_mgal, "", "in sample");
    add("RMS error of a reading left out", score.loo_mgal, "", "cross-validated (leave-one-out)");
    add("RMS error of a station left out", score.loso_mgal, "",
        "cross-validated (leave-one-station-out)");
    add("the same, with the model chosen again each time", result.choice_loso_mgal, "",
        "cross-validated (leave-one-station-out)");
    return html_table("lrrl", {"Quantity", "mGal", "its standard error", "Kind"}, rows);
}

std::string counted(std::size_t count, const std::string& what) {
    return std::to_string(count) + ' ' + what + (count == 1 ? "" : "s");
}

std::string headline(const SurveyCorrection& result) {
    const UtcTime first = result.rows.front().row.time;
    const UtcTime last = result.rows.back().row.time;
    std::string text = to_rfc3339(first) + " to " + to_rfc3339(last) + ": " +
                       counted(result.rows.size(), "reading") + " of " +
                       counted(result.stations.size(), "station") + ", base " +
                       result.options.base + ". Model " + result.model;
    if (result.options.model == "auto") {
        text += result.model == "day" ? " (chosen because the whole day was recorded)"
                                      : " (chosen by the error of stations left out)";
    }
    text += "; " + counted(result.score.row_count, "reading") + " in the fit, " +
            counted(result.score.parameter_count, result.network ? "unknown" : "coefficient");
    if (result.network) {
        text += ", of which " + counted(result.network->stations.size(), "station") + " (" +
                std::to_string(result.network->datum_count) + " held)";
    }
    return text + ", " + std::to_string(result.score.dof) + " degrees of freedom.";
}

}  // namespace

std::vector<std::string> actions(const SurveyCorrection& result,
                                 const std::vector<ReadingGrade>& grades) {
    std::vector<std::string> urgent, optional, care, trusted;
    for (std::size_t i = 0; i < grades.size(); ++i) {
        const std::string name = reading_name(result.rows, i);
        if (grades[i].grade == Grade::trust) {
            trusted.push_back(name);
        } else if (grades[i].grade == Grade::care) {
            care.push_back(name);
        } else if (has_trusted_reading(result, grades, result.rows[i].row.site)) {
            optional.push_back(name);
        } else {
            urgent.push_back(name);
        }
    }
    std::vector<std::string> list;
    const auto add = [&list](const std::string& what, const std::vector<std::string>& names) {
        if (!names.empty()) list.push_back(what + ": " + text::joined(names) + ".");
    };
    for (const auto& [reason, names] : left_out_by_reason(result))
        add("Repeat, without a value (" + reason + ")", names);
    add("Repeat, the station has no other reading to trust", urgent);
    add("Repeat if there is time, the station has another reading to trust", optional);
    if (list.empty()) list.emplace_back("No reading needs to be repeated.");
    add("Use with care", care);
    add("Trust", trusted);
    return list;
}

std::vector<std::string> limits_of(const SurveyCorrection& result) {
    constexpr std::size_t kFewestBaseReadings = 3;  // two cannot separate drift from a bad reading
    std::size_t base_count = 0;
    for (const CorrectedRow& row : result.rows) {
        if (row.row.site == result.options.base && row.is_used) ++base_count;
    }
    std::vector<std::string> limits;
    if (base_count < kFewestBaseReadings) {
        limits.push_back("The base " + result.options.base + " has " +
                         counted(base_count, "reading") +
                         " in the fit; three readings spread over the day separate drift from a "
                         "bad reading.");
    }
    std::size_t single_count = 0;
    std::vector<std::string> unchecked;
    for (const StationValue& station : result.stations) {
        if (station.row_count > 1) continue;
        ++single_count;
        if (!station.reference) unchecked.push_back(station.site);
    }
    if (single_count > 0) {
        limits.push_back(std::to_string(single_count) + " of " +
                         std::to_string(result.stations.size()) +
                         " stations have only one reading: only a known reference can show a "
                         "blunder there.");
    }
    if (!unchecked.empty()) {
        limits.push_back("One reading and no reference, so nothing checks them: " +
                         text::joined(unchecked) + ".");
    }
    return limits;
}

std::optional<double> standard_error_of_rms(const ModelScore& score) {
    if (!score.rms_mgal || score.dof == 0) return std::nullopt;
    return *score.rms_mgal / std::sqrt(2.0 * static_cast<double>(score.dof));
}

std::string scatter_sentence(const ModelScore& score) {
    const auto error = standard_error_of_rms(score);
    const std::string n = "n = " + std::to_string(score.row_count);
    const std::string quote =
        " For a new station quote " +
        (score.loso_mgal
             ? text::fixed(*score.loso_mgal, 2) + " mGal (cross-validated, leave-one-station-out)."
             : std::string("the leave-one-station-out error; it cannot be computed for this "
                           "model and these readings."));
    if (!error) {
        return n +
               ": no degree of freedom is left in the fit, so the residuals say nothing about "
               "accuracy." +
               quote;
    }
    return n + ": the scatter of " + text::fixed(*score.rms_mgal, 2) +
           " mGal (in sample) has itself a standard error of about " + text::fixed(*error, 2) +
           " mGal, RMS / sqrt(2 dof) with " + std::to_string(score.dof) +
           " degrees of freedom. Smaller differences between models are not significant." + quote;
}

std::string summary_html(const SurveyCorrection& result, const std::vector<std::string>& warnings,
                         const std::vector<std::string>& missing) {
    const std::vector<ReadingGrade> grades = grade_readings(result);
    std::string html = html_paragraph(headline(result));
    html += "<h2>What to do</h2>\n" + html_list(actions(result, grades)) +
            reading_table(result, grades);
    html += "<h2>Accuracy</h2>\n" + accuracy_table(result) +
            html_paragraph(scatter_sentence(result.score));
    std::vector<std::string> limits = limits_of(result);
    if (!warnings.empty()) {
        limits.push_back("Warnings about the input: " + std::to_string(warnings.size()) +
                         ", see the last section.");
    }
    limits.insert(limits.end(), missing.begin(), missing.end());
    if (!limits.empty()) html += "<h2>Limits</h2>\n" + html_list(limits);
    return html;
}

}  // namespace a351::corrector
