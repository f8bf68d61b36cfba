#include "corrector/result/table_text.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "corrector/model/row_doubts.hpp"
#include "corrector/result/network_report.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

using Cells = std::vector<std::string>;

template <class Value>
std::string cell(const std::optional<Value>& value, int decimals) {
    return text::fixed_or(value, decimals, "-");
}

std::string occupations_text(const SurveyCorrection& result) {
    std::vector<Cells> rows{{"site", "occ", "time UTC", "fit", "accel. mGal", "T degC", "degC/h",
                             "tide", "diff.", "corrected", "reference", "residual", "u", "flags"}};
    const auto add_row = [&](std::size_t i) {
        const CorrectedRow& row = result.rows[i];
        rows.push_back(
            {row.row.site, std::to_string(row.row.occupation), to_rfc3339(row.row.time),
             row.is_used ? "yes" : "no", text::fixed(row.row.acceleration.value(), 3),
             text::fixed(row.row.temperature.value(), 3), text::fixed(row.row.rate_degc_per_h, 3),
             text::fixed(row.row.tide.value(), 3), cell(row.difference, 3),
             text::fixed(row.corrected.value(), 3), cell(row.row.reference, 3),
             cell(row.residual, 3), cell(row.u_corrected, 2), flags_of(row, result.options)});
    };
    in_order_of_time(result, add_row, [&rows](const LeftOut& stay) {
        Cells& cells = rows.emplace_back(rows.front().size(), "-");
        cells[0] = stay.site;
        cells[1] = std::to_string(stay.occupation);
        cells[2] = to_rfc3339(stay.start);
        cells.back() = flag_of(stay);
    });
    return text::aligned(rows);
}

std::string stations_text(const SurveyCorrection& result) {
    std::vector<Cells> rows{
        {"station", "n", "gravity mGal", "u", "reference", "residual", "redundancy", ""}};
    for (const StationValue& station : result.stations) {
        rows.push_back({station.site, std::to_string(station.row_count),
                        text::fixed(station.gravity.value(), 3), cell(station.u_gravity, 2),
                        cell(station.reference, 3), cell(station.residual, 3),
                        cell(station.redundancy, 2),
                        station.is_flagged_only ? "flagged only" : ""});
    }
    return text::aligned(rows);
}

std::string models_text(const SurveyCorrection& result) {
    std::vector<Cells> rows{{"model", "rows", "n", "p", "dof", "RMS (in sample)", "s (in sample)",
                             "RMS (leave-one-out)", "RMS (leave-one-station-out)", "AICc", ""}};
    for (const ScoreRow& row : score_rows(result)) {
        rows.push_back(score_cells(row));
        rows.back().push_back(is_selected(result, row) ? "<" : "");
    }
    return text::aligned(rows);
}

std::string coefficients_text(const SurveyCorrection& result) {
    std::string text;
    for (const Coefficient& c : result.coefficients) {
        text += fmt::format("  {} = {}", c.name, text::fixed(c.value, 4));
        if (c.standard_error) text += " +- " + text::fixed(*c.standard_error, 4);
        if (const Prior* const prior = result.options.priors.find(c.name);
            prior != nullptr && result.model != "paper") {
            text += fmt::format(" (prior {} +- {})", text::fixed(prior->mean, 4),
                                text::fixed(prior->sd, 4));
        }
        text += '\n';
    }
    return text;
}

std::string summary_text(const SurveyCorrection& result) {
    const ModelScore& score = result.score;
    std::string text = "model " + result.model;
    if (result.options.model == "auto") {
        text += result.model == "day" ? " (chosen because the whole day was recorded)"
                                      : " (chosen by leave-one-station-out error)";
    }
    text +=
        fmt::format(": RMS {} mGal (in sample, n = {})", cell(score.rms_mgal, 3), score.row_count);
    const auto add = [&text](std::string_view before, const std::optional<double>& value_mgal,
                             std::string_view behind) {
        if (value_mgal) text += fmt::format("{}{} mGal {}", before, cell(value_mgal, 3), behind);
    };
    add(", ", score.loo_mgal, "(leave-one-out)");
    add(", ", score.loso_mgal, "(leave-one-station-out)");
    text += '\n';
    if (const auto& interval = result.loo_interval_mgal) {
        text += fmt::format("leave-one-out, 95 % interval by resampling stations: {} to {} mGal\n",
                            text::fixed(interval->low, 2), text::fixed(interval->high, 2));
    }
    add("RMS of Error (1), before the drift step: ", score.rms_before_drift_mgal,
        fmt::format("(in sample); of Error (2), after it: {} mGal (in sample)\n",
                    cell(score.rms_mgal, 3)));
    add("with the choice of the model repeated for every station left out: ",
        result.choice_loso_mgal, "(leave-one-station-out)\n");
    return text;
}

std::string weights_text(const SurveyCorrection& result) {
    std::string text;
    for (const CorrectedRow& row : result.rows) {
        if (!row.weight) continue;
        text += text.empty() ? "weights of the robust fit of " + result.options.robust_terms + ": "
                             : ", ";
        text += fmt::format("{} ({}) {}", row.row.site, row.row.occupation,
                            text::fixed(*row.weight, 2));
    }
    return text.empty() ? text : text + '\n';
}

}  // namespace

std::string flags_of(const CorrectedRow& row, const SurveyOptions& options) {
    std::vector<std::string> flags = row.row.notes;
    if (row.row.is_flagged) flags.insert(flags.begin(), "outlier");
    const auto& datum = options.datum;
    if (!row.row.reference) {
        flags.emplace_back("no-reference");
    } else if (!datum.empty() && std::ranges::count(datum, row.row.site) == 0) {
        flags.emplace_back("not-datum");
    }
    return text::joined(flags, ";");
}

std::string flag_of(const LeftOut& occupation) {
    std::string flag = occupation.reason;
    std::replace(flag.begin(), flag.end(), ' ', '-');
    return flag;
}

void in_order_of_time(const SurveyCorrection& result, const std::function<void(std::size_t)>& row,
                      const std::function<void(const LeftOut&)>& left_out) {
    auto next = result.left_out.begin();
    for (std::size_t i = 0; i <= result.rows.size(); ++i) {
        const UtcTime time = i < result.rows.size() ? result.rows[i].row.time : UtcTime::max();
        for (; next != result.left_out.end() && next->start < time; ++next) left_out(*next);
        if (i < result.rows.size()) row(i);
    }
}

std::vector<ScoreRow> score_rows(const SurveyCorrection& result) {
    std::vector<ScoreRow> rows;
    for (const ScoredRowSet& set : result.row_sets)
        for (const ModelScore& score : set.scores) rows.push_back({&set, &score});
    return rows;
}

bool is_selected(const SurveyCorrection& result, const ScoreRow& row) {
    return row.score->model == result.model &&
           row.set->rows == (result.options.use_flags ? "used" : "all");
}

std::vector<std::string> score_cells(const ScoreRow& row) {
    const ModelScore& score = *row.score;
    return {score.model,
            row.set->rows,
            std::to_string(score.row_count),
            std::to_string(score.parameter_count),
            std::to_string(score.dof),
            cell(score.rms_mgal, 3),
            cell(score.s_mgal, 3),
            cell(score.loo_mgal, 3),
            cell(score.loso_mgal, 3),
            cell(score.aicc, 2)};
}

std::string survey_text(const SurveyCorrection& result) {
    std::string text = occupations_text(result) + '\n' + stations_text(result) + '\n' +
                       models_text(result) + '\n' + summary_text(result) +
                       coefficients_text(result) + network_text(result) + weights_text(result) +
                       doubts_text(result);
    for (const std::string& remark : result.remarks) text += remark + '\n';
    return text;
}

}  // namespace a351::corrector
