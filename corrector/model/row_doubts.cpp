#include "corrector/model/row_doubts.hpp"

#include <cmath>

#include "corrector/model/outlier_tests.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

std::optional<StudentisedRows> refit_linear(const LinearModel& model,
                                            const std::vector<SurveyRow>& rows,
                                            const ModelPriors& priors,
                                            const std::vector<bool>& in_use) {
    std::vector<SurveyRow> used;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (in_use[i]) used.push_back(rows[i]);
    }
    const UtcTime origin = rows.front().time;
    const auto fit = fit_model(model, used, origin, priors);
    if (!fit) return std::nullopt;
    StudentisedRows result;
    result.dof = static_cast<std::size_t>(fit->dof());
    const Eigen::MatrixXd columns = model_columns(model, rows, origin);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Eigen::VectorXd x = columns.row(static_cast<Eigen::Index>(i)).transpose();
        result.values.emplace_back();
        if (!rows[i].reference) continue;
        const MilliGal corrected = rows[i].acceleration - rows[i].tide - MilliGal(fit->at(x));
        result.values.back() = studentised_residual((*rows[i].reference - corrected).value(),
                                                    fit->leverage_at(x), in_use[i], *fit);
    }
    return result;
}

std::optional<StudentisedRows> refit_network(const SurveyOptions& options,
                                             const std::vector<SurveyRow>& rows,
                                             const std::vector<bool>& in_use) {
    const NetworkResult network =
        adjust_network(rows, in_use, options.datum, options.priors, options.network);
    if (!network.adjustment) return std::nullopt;
    StudentisedRows result;
    result.dof = network.adjustment->dof;
    std::size_t reading = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        result.values.emplace_back();
        if (in_use[i]) result.values.back() = network.adjustment->studentised(reading++);
    }
    return result;
}

std::string statistical_doubt(double studentised, double limit) {
    return "t " + text::fixed(studentised, 2) + " over " + text::fixed(limit, 2);
}

/// Tests the errors of the prediction without the row's station.  Here one bad row does not hide
/// another, so no row is removed.
void test_left_out(SurveyCorrection& result) {
    const ModelScore& score = result.score;
    if (score.dof == 0) return;
    const double limit = studentised_limit(score.row_count, static_cast<double>(score.dof));
    for (CorrectedRow& row : result.rows) {
        if (row.studentised_residual && std::abs(*row.studentised_residual) > limit)
            row.doubt_statistical = statistical_doubt(*row.studentised_residual, limit);
    }
}

}  // namespace

void set_doubts(SurveyCorrection& result) {
    std::vector<SurveyRow> rows;
    std::vector<bool> in_use;
    for (CorrectedRow& row : result.rows) {
        row.doubt_physical = physical_doubt(row.row);
        rows.push_back(row.row);
        in_use.push_back(row.is_used);
    }
    if (result.model == "day") test_left_out(result);
    const LinearModel* const model =
        find_linear_model(result.model == "robust" ? result.options.robust_terms : result.model);
    if (model == nullptr && !result.network) return;
    const auto doubts = find_outliers(in_use, [&](const std::vector<bool>& remaining) {
        return model != nullptr ? refit_linear(*model, rows, result.options.priors, remaining)
                                : refit_network(result.options, rows, remaining);
    });
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!doubts[i]) continue;
        result.rows[i].doubt_statistical =
            statistical_doubt(doubts[i]->studentised, doubts[i]->limit);
    }
}

std::string doubts_text(const SurveyCorrection& result) {
    std::string text;
    for (const CorrectedRow& row : result.rows) {
        if (row.doubt_physical.empty() && row.doubt_statistical.empty()) continue;
        text += "  " + row.row.site + " (" + std::to_string(row.row.occupation) + "):";
        if (!row.doubt_physical.empty()) text += " physical: " + row.doubt_physical;
        if (!row.doubt_physical.empty() && !row.doubt_statistical.empty()) text += ',';
        if (!row.doubt_statistical.empty()) text += " statistical: " + row.doubt_statistical;
        text += '\n';
    }
    if (text.empty()) return "doubtful readings: none\n";
    return "doubtful readings (none is left out because of this):\n" + text;
}

}  // namespace a351::corrector
