#include "corrector/result/table_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>

#include "corrector/model/model.hpp"
#include "corrector/model/trend_comparison.hpp"
#include "corrector/result/answer.hpp"
#include "corrector/result/columns.hpp"
#include "corrector/result/network_report.hpp"
#include "corrector/result/paper_report.hpp"
#include "corrector/result/scale_report.hpp"
#include "corrector/result/side_by_side_report.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/columns.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::result {

using text::tr;

namespace {

std::string occupations_text(const model::SurveyCorrection& result) {
    const auto columns = with_decimals(
        with_keys(
            occupation_columns(result),
            {"site", "occupation", "time_utc", "used", "acceleration_mgal", "temperature_degc",
             "rate_degc_per_h", "tide_mgal", "height_correction_mgal", "pressure_correction_mgal",
             "difference_mgal", "corrected_mgal", "reference_mgal", "residual_mgal",
             "u_corrected_mgal", "used_min", "recorded_min", "face", "flags"}),
        decimals_of(result) + 1);
    Table table = empty_table(columns);
    in_order_of_time(
        result, [&](std::size_t i) { table.rows.push_back(shown_row(columns, result.rows[i])); },
        [&](const reading::LeftOut& stay) {
            std::vector<std::string>& cells = table.rows.emplace_back(columns.size(), "-");
            cells[0] = stay.site;
            cells[1] = std::to_string(stay.occupation);
            cells[2] = to_rfc3339(stay.start);
            cells.back() = flag_of(stay);
        });
    return aligned_text(table);
}

int decimals_of_scores(const model::SurveyCorrection& result) {
    return std::max(2, decimals_of(result));
}

std::string coefficients_text(const model::SurveyCorrection& result) {
    std::string text;
    for (const model::Coefficient& c : result.coefficients) {
        const int decimals = decimals_of(c);
        text += fmt::format("  {} = {}", c.name, text::fixed(c.value, decimals));
        if (c.standard_error) text += " +- " + text::fixed(*c.standard_error, decimals);
        if (const adjustment::Prior* const prior = result.options.priors.find(c.name);
            prior != nullptr && c.prior) {
            text += fmt::format(" (prior {} +- {})", text::fixed(prior->mean, 4),
                                text::fixed(prior->sd, 4));
        }
        text += '\n';
    }
    return text;
}

std::string summary_text(const model::SurveyCorrection& result) {
    const model::Score& score = result.score;
    const int decimals = decimals_of_scores(result);
    std::string text =
        tr("model {}{}: RMS {} mGal (in sample, n = {})", result.model, choice_text(result),
           text::fixed_or(score.rms_mgal, decimals, "-"), score.row_count);
    const auto add = [&](const std::optional<double>& value_mgal, const std::string& kind) {
        if (value_mgal)
            text += fmt::format(", {} mGal ({})", text::fixed(*value_mgal, decimals), kind);
    };
    add(score.loo_mgal, tr("leave-one-out"));
    add(score.loso_mgal, tr("leave-one-station-out"));
    add(result.choice_loso_mgal,
        tr("leave-one-station-out, with the model chosen again each time"));
    add(score.rms_before_drift_mgal, tr("in sample, before the drift step"));
    text += '\n';
    if (const auto interval = result.loo_interval_mgal)
        text += tr("leave-one-out, 95 % interval by resampling stations: {} to {} mGal",
                   text::fixed(interval->low, 2), text::fixed(interval->high, 2)) +
                '\n';
    return text;
}

/// Appends a text as lines of at most kWidth columns, the further ones indented.
void add_lines(std::string& lines, const std::string& text) {
    constexpr std::size_t kWidth = 118;
    std::istringstream words(text);
    std::string line;
    for (std::string word; words >> word;) {
        if (!line.empty() && text::columns_of(line) + 1 + text::columns_of(word) > kWidth) {
            lines += line + '\n';
            line = "  " + word;
        } else {
            line += (line.empty() ? "" : " ") + word;
        }
    }
    lines += line + '\n';
}

/// Appends the findings with their numbers, as `a351-correct amend` counts them: the mistakes, or
/// the remarks.
void add_findings(std::string& lines, const std::vector<reading::Finding>& findings,
                  bool are_remarks) {
    for (std::size_t k = 0; k < findings.size(); ++k)
        if (reading::is_remark(findings[k]) == are_remarks)
            add_lines(lines, fmt::format("{}. {}", k + 1, text::in_words(findings[k].text)));
}

/// Returns the tables and models that are in the files of the result too.
std::string details_text(const model::SurveyCorrection& result) {
    std::string text = occupations_text(result) + '\n' + aligned_text(stations_table(result)) +
                       '\n' + aligned_text(models_table(result)) +
                       tr("LOO: leave-one-out. LOSO: leave-one-station-out.") + "\n\n" +
                       summary_text(result) + coefficients_text(result) + network_text(result);
    if (is_paper(result))
        text += '\n' + aligned_text(paper_table(result)) + paper_errors(result) + '\n';
    for (const std::string& sentence : scale_sentences(result)) text += sentence + '\n';
    for (const std::string& sentence : side_by_side_sentences(result)) text += sentence + '\n';
    for (const text::Message& remark : result.remarks) text += text::in_words(remark) + '\n';
    return text + model::trend_comparison_text(result);
}

}  // namespace

std::string choice_text(const model::SurveyCorrection& result) {
    if (result.options.model != model::kAutomatic) return "";
    if (result.choice) return tr(" (chosen by leave-one-station-out error)");
    return result.as<model::WholeDayPart>() != nullptr
               ? tr(" (chosen because the whole day was recorded)")
               : tr(" (chosen because the known stations do not allow to compare models)");
}

std::string flags_of(const model::CorrectedRow& row, const model::SurveyOptions& options) {
    std::vector<std::string> flags = row.row.notes;
    if (row.row.is_flagged) flags.insert(flags.begin(), "outlier");
    const auto& datum = options.datum;
    if (!row.row.reference) {
        flags.emplace_back("no-reference");
    } else if (row.row.is_reference_refused) {
        flags.emplace_back("reference-not-used");
    } else if (!datum.empty() && std::ranges::count(datum, row.row.site) == 0) {
        flags.emplace_back("not-datum");
    }
    return text::joined(flags, ";");
}

std::string flag_of(const reading::LeftOut& occupation) {
    std::string flag = occupation.reason;
    std::replace(flag.begin(), flag.end(), ' ', '-');
    return flag;
}

void in_order_of_time(const model::SurveyCorrection& result,
                      const std::function<void(std::size_t)>& row,
                      const std::function<void(const reading::LeftOut&)>& left_out) {
    auto next = result.left_out.begin();
    for (std::size_t i = 0; i <= result.rows.size(); ++i) {
        const UtcTime time = i < result.rows.size() ? result.rows[i].row.time : UtcTime::max();
        for (; next != result.left_out.end() && next->start < time; ++next) left_out(*next);
        if (i < result.rows.size()) row(i);
    }
}

std::vector<ScoreRow> score_rows(const model::SurveyCorrection& result) {
    std::vector<ScoreRow> rows;
    for (const model::ScoredRowSet& set : result.row_sets)
        for (const model::Score& score : set.scores) rows.push_back({&set, &score});
    return rows;
}

bool is_selected(const model::SurveyCorrection& result, const ScoreRow& row) {
    return row.score->model == result.model &&
           row.set->rows == (result.options.use_flags ? "used" : "all");
}

Table stations_table(const model::SurveyCorrection& result) {
    std::vector<std::string_view> keys{"site",           "n",
                                       "gravity_mgal",   "u_gravity_mgal",
                                       "reference_mgal", "residual_mgal",
                                       "left_out_mgal",  "expanded_u_mgal",
                                       "redundancy"};
    if (std::ranges::any_of(result.stations, &model::StationValue::is_flagged_only))
        keys.emplace_back("flagged_only");
    for (const auto key : {"normal_gravity_mgal", "free_air_anomaly_mgal", "bouguer_anomaly_mgal"})
        keys.emplace_back(key);
    return table_of(
        with_decimals(with_keys(station_columns(result.stations), keys), decimals_of(result)),
        result.stations);
}

Table budget_table(const model::SurveyCorrection& result) {
    std::vector<model::StationValue> stations = result.stations;
    std::erase_if(stations, [](const model::StationValue& station) { return !station.parts_mgal; });
    std::vector<std::string_view> keys{"site"};
    for (const auto& [key, heading] : kContributions) keys.push_back(key);
    keys.insert(keys.end(), {"u_gravity_mgal", "expanded_u_mgal"});
    return table_of(with_keys(station_columns(stations), keys), stations);
}

Table models_table(const model::SurveyCorrection& result) {
    return table_of(with_decimals(with_keys(score_columns(result),
                                            {"model", "rows", "n", "p", "dof", "rms_mgal", "s_mgal",
                                             "loo_mgal", "loso_mgal", "aicc", "selected"}),
                                  decimals_of_scores(result)),
                    score_rows(result));
}

std::string survey_text(const model::SurveyCorrection& result, bool is_verbose) {
    const std::vector<judgement::ReadingGrade> grades = judgement::grade_readings(result);
    std::string text;
    add_lines(text, answer(result, grades));
    add_findings(text, result.findings, false);
    text += '\n' + aligned_text(answer_table(result, grades));
    std::string below;
    for (const std::string& note : notes(result, grades)) add_lines(below, note);
    add_findings(below, result.findings, true);
    if (!below.empty()) text += '\n' + below;
    return is_verbose ? text + '\n' + details_text(result) : text;
}

}  // namespace a351::corrector::result
