#include "corrector/model/row_doubts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "corrector/model/outlier_tests.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

/// A fit to the rows in use.
struct StudentisedRows {
    std::vector<std::optional<double>> values;  ///< (n) Studentised residuals; absent: undefined.
    std::size_t dof = 0;                        ///< Degrees of freedom of the fit.
};

std::optional<StudentisedRows> refit_linear(const LinearModel& model,
                                            const std::vector<SurveyRow>& rows,
                                            const ModelPriors& priors,
                                            const std::vector<bool>& in_use) {
    const UtcTime origin = rows.front().time;
    const auto fit = fit_model(model, chosen_rows(rows, in_use), origin, priors);
    if (!fit) return std::nullopt;
    StudentisedRows result;
    result.dof = static_cast<std::size_t>(fit->dof());
    result.values.resize(rows.size());
    const Eigen::MatrixXd columns = model_columns(model, rows, origin);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!rows[i].reference) continue;
        const Eigen::VectorXd x = columns.row(static_cast<Eigen::Index>(i)).transpose();
        const MilliGal corrected = rows[i].acceleration - rows[i].tide - MilliGal(fit->at(x));
        result.values[i] = studentised_residual((*rows[i].reference - corrected).value(),
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
    result.values.resize(rows.size());
    std::size_t reading = 0;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (in_use[i]) result.values[i] = network.adjustment->studentised(reading++);
    return result;
}

std::string statistical_doubt(double studentised, double limit) {
    return fmt::format("t {} over {}", text::fixed(studentised, 2), text::fixed(limit, 2));
}

/// Tests all rows.
///
/// As long as the largest |t| in use is above studentised_limit() with dof - 1, its row is removed
/// and the rest is fitted again.  Then rows that were not in use from the start are tested against
/// the last fit, with dof.  The search ends early if a fit is undetermined or has fewer than two
/// degrees of freedom; the doubts found until then remain.  Two bad rows of equal size may hide
/// each other; the robust fit does not have this weakness.
/// @param in_use  (n) rows of the first fit.
/// @param refit   fits the rows that are left; std::nullopt if they do not determine the fit.
template <class Refit>
void test_in_turn(std::vector<CorrectedRow>& rows, std::vector<bool> in_use, const Refit& refit) {
    const std::vector<bool> in_use_at_first = in_use;
    for (;;) {
        const std::optional<StudentisedRows> fit = refit(in_use);
        if (!fit || fit->dof < 2) return;
        const auto n = static_cast<std::size_t>(std::count(in_use.begin(), in_use.end(), true));
        const auto size_of = [&](std::size_t i) { return std::abs(fit->values[i].value_or(0.0)); };
        const auto doubt = [&](std::size_t i, double limit) {
            rows[i].doubt_statistical = statistical_doubt(*fit->values[i], limit);
        };
        std::optional<std::size_t> worst;
        for (std::size_t i = 0; i < in_use.size(); ++i)
            if (in_use[i] && (!worst || size_of(i) > size_of(*worst))) worst = i;
        const double limit = studentised_limit(n, static_cast<double>(fit->dof - 1));
        if (worst && size_of(*worst) > limit) {
            doubt(*worst, limit);
            in_use[*worst] = false;
            continue;
        }
        // A row outside the fit is tested with s of the whole fit, which has dof, not dof - 1.
        const double limit_outside = studentised_limit(n, static_cast<double>(fit->dof));
        for (std::size_t i = 0; i < in_use.size(); ++i)
            if (!in_use_at_first[i] && size_of(i) > limit_outside) doubt(i, limit_outside);
        return;
    }
}

/// Tests the errors of the prediction without the row's station.  Here one bad row does not hide
/// another, so no row is removed.
void test_left_out(SurveyCorrection& result) {
    const ModelScore& score = result.score;
    if (score.dof == 0) return;
    const double limit = studentised_limit(score.row_count, static_cast<double>(score.dof));
    for (CorrectedRow& row : result.rows)
        if (row.studentised_residual && std::abs(*row.studentised_residual) > limit)
            row.doubt_statistical = statistical_doubt(*row.studentised_residual, limit);
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
    test_in_turn(result.rows, in_use, [&](const std::vector<bool>& remaining) {
        return model != nullptr ? refit_linear(*model, rows, result.options.priors, remaining)
                                : refit_network(result.options, rows, remaining);
    });
}

std::string doubts_text(const SurveyCorrection& result) {
    std::string text;
    for (const CorrectedRow& row : result.rows) {
        if (row.doubt_physical.empty() && row.doubt_statistical.empty()) continue;
        text += fmt::format("  {} ({}):", row.row.site, row.row.occupation);
        if (!row.doubt_physical.empty()) text += " physical: " + row.doubt_physical;
        if (!row.doubt_physical.empty() && !row.doubt_statistical.empty()) text += ',';
        if (!row.doubt_statistical.empty()) text += " statistical: " + row.doubt_statistical;
        text += '\n';
    }
    if (text.empty()) return "doubtful readings: none\n";
    return "doubtful readings (none is left out because of this):\n" + text;
}

}  // namespace a351::corrector
