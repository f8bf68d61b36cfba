#include "corrector/result/table_text.hpp"

#include <algorithm>
#include <vector>

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
    auto left_out = result.left_out.begin();
    const auto add_left_out_before = [&](UtcTime time) {
        for (; left_out != result.left_out.end() && left_out->start < time; ++left_out) {
            Cells& cells = rows.emplace_back(rows.front().size(), "-");
            cells[0] = left_out->site;
            cells[1] = std::to_string(left_out->occupation);
            cells[2] = to_rfc3339(left_out->start);
            cells.back() = flag_of(*left_out);
        }
    };
    for (const CorrectedRow& row : result.rows) {
        add_left_out_before(row.row.time);
        rows.push_back(
            {row.row.site, std::to_string(row.row.occupation), to_rfc3339(row.row.time),
             row.is_used ? "yes" : "no", text::fixed(row.row.acceleration.value(), 3),
             text::fixed(row.row.temperature.value(), 3), text::fixed(row.row.rate_degc_per_h, 3),
             text::fixed(row.row.tide.value(), 3), cell(row.difference, 3),
             text::fixed(row.corrected.value(), 3), cell(row.row.reference, 3),
             cell(row.residual, 3), cell(row.u_corrected, 2), flags_of(row, result.options)});
    }
    add_left_out_before(UtcTime::max());
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
    for (const ScoredRowSet& set : result.row_sets) {
        for (const ModelScore& score : set.scores) {
            rows.push_back(score_cells(set, score));
            rows.back().push_back(is_selected(result, set, score) ? "<" : "");
        }
    }
    return text::aligned(rows);
}

std::string coefficients_text(const SurveyCorrection& result) {
    std::string text;
    for (const Coefficient& c : result.coefficients) {
        text += "  " + c.name + " = " + text::fixed(c.value, 4);
        if (c.standard_error) text += " +- " + text::fixed(*c.standard_error, 4);
        if (const Prior* const prior = result.options.priors.find(c.name);
            prior != nullptr && result.model != "paper") {
            text +=
                " (prior " + text::fixed(prior->mean, 4) + " +- " + text::fixed(prior->sd, 4) + ')';
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
    text += ": RMS " + cell(score.rms_mgal, 3) +
            " mGal (in sample, n = " + std::to_string(score.row_count) + ")";
    if (score.loo_mgal) text += ", " + text::fixed(*score.loo_mgal, 3) + " mGal (leave-one-out)";
    if (score.loso_mgal) {
        text += ", " + text::fixed(*score.loso_mgal, 3) + " mGal (leave-one-station-out)";
    }
    text += '\n';
    if (const auto& interval = result.loo_interval_mgal) {
        text += "leave-one-out, 95 % interval by resampling stations: " +
                text::fixed(interval->low, 2) + " to " + text::fixed(interval->high, 2) + " mGal\n";
    }
    if (score.rms_before_drift_mgal) {
        text += "RMS of Error (1), before the drift step: " + cell(score.rms_before_drift_mgal, 3) +
                " mGal (in sample); of Error (2), after it: " + cell(score.rms_mgal, 3) +
                " mGal (in sample)\n";
    }
    if (result.choice_loso_mgal) {
        text += "with the choice of the model repeated for every station left out: " +
                cell(result.choice_loso_mgal, 3) + " mGal (leave-one-station-out)\n";
    }
    return text;
}

std::string weights_text(const SurveyCorrection& result) {
    std::string text;
    for (const CorrectedRow& row : result.rows) {
        if (!row.weight) continue;
        text += (text.empty() ? "weights of the robust fit of " + result.options.robust_terms + ": "
                              : ", ") +
                row.row.site + " (" + std::to_string(row.row.occupation) + ") " +
                text::fixed(*row.weight, 2);
    }
    return text.empty() ? text : text + '\n';
}

}  // namespace

std::string flags_of(const CorrectedRow& row, const SurveyOptions& options) {
    std::string flags;
    const auto add = [&flags](const std::string& flag) {
        flags += (flags.empty() ? "" : ";") + flag;
    };
    if (row.row.is_flagged) add("outlier");
    for (const std::string& note : row.row.notes) add(note);
    const auto& datum = options.datum;
    if (!row.row.reference) {
        add("no-reference");
    } else if (!datum.empty() &&
               std::find(datum.begin(), datum.end(), row.row.site) == datum.end()) {
        add("not-datum");
    }
    return flags;
}

std::string flag_of(const LeftOut& occupation) {
    std::string flag = occupation.reason;
    std::replace(flag.begin(), flag.end(), ' ', '-');
    return flag;
}

bool is_selected(const SurveyCorrection& result, const ScoredRowSet& set, const ModelScore& score) {
    return score.model == result.model && set.rows == (result.options.use_flags ? "used" : "all");
}

std::vector<std::string> score_cells(const ScoredRowSet& set, const ModelScore& score) {
    return {score.model,
            set.rows,
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
