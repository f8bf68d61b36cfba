#include <algorithm>
#include <cmath>

#include "corrector/model/paper_correction.hpp"
#include "corrector/model/robust_fit.hpp"

namespace a351::corrector {
namespace {

/// Returns the root mean square error (mGal) of predicting each row from the rows that `is_other`
/// keeps for it.
template <class IsOther>
std::optional<double> left_out_mgal(const LinearModel& model, const std::vector<SurveyRow>& rows,
                                    UtcTime origin, const ModelPriors& priors,
                                    const IsOther& is_other) {
    const Eigen::MatrixXd columns = model_columns(model, rows, origin);
    const std::vector<double> differences = differences_mgal(rows);
    std::vector<std::optional<double>> errors(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (errors[i]) continue;
        std::vector<SurveyRow> others;
        std::vector<std::size_t> left_out;
        for (std::size_t k = 0; k < rows.size(); ++k) {
            if (is_other(k, i)) {
                others.push_back(rows[k]);
            } else {
                left_out.push_back(k);
            }
        }
        const auto robust = fit_robust_model(model, others, origin, priors);
        if (!robust) return std::nullopt;
        for (const std::size_t k : left_out) {
            const auto x = columns.row(static_cast<Eigen::Index>(k)).transpose();
            errors[k] = differences[k] - robust->fit.at(x);
        }
    }
    double squares = 0.0;
    for (const auto& error : errors) squares += *error * *error;
    return std::sqrt(squares / static_cast<double>(rows.size()));
}

}  // namespace

std::optional<RobustFit> fit_robust_model(const LinearModel& model,
                                          const std::vector<SurveyRow>& rows, UtcTime origin,
                                          const ModelPriors& priors) {
    if (rows.empty()) return std::nullopt;
    const std::vector<double> differences = differences_mgal(rows);
    const Eigen::Map<const Eigen::VectorXd> y(differences.data(),
                                              static_cast<Eigen::Index>(differences.size()));
    return fit_robust(model_columns(model, rows, origin), y, slope_priors(model, priors));
}

ModelScore score_robust_model(const LinearModel& model, const std::vector<SurveyRow>& rows,
                              UtcTime origin, const ModelPriors& priors) {
    ModelScore score;
    score.model = "robust";
    score.row_count = rows.size();
    score.parameter_count = model.parameter_count();
    const auto robust = fit_robust_model(model, rows, origin, priors);
    if (!robust) return score;
    score.dof = score.row_count - score.parameter_count;
    score.rms_mgal = std::sqrt(robust->fit.rss / static_cast<double>(rows.size()));
    score.s_mgal = robust->s;
    score.loo_mgal = left_out_mgal(model, rows, origin, priors,
                                   [](std::size_t k, std::size_t i) { return k != i; });
    score.loso_mgal = left_out_mgal(model, rows, origin, priors, [&](std::size_t k, std::size_t i) {
        return rows[k].site != rows[i].site;
    });
    return score;
}

}  // namespace a351::corrector
