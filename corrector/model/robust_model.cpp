#include <fmt/core.h>

#include <cmath>

#include "corrector/model/applied_fit.hpp"
#include "corrector/model/model.hpp"
#include "corrector/model/robust_fit.hpp"
#include "corrector/model/row_doubts.hpp"

namespace a351::corrector::model {
namespace {

const LinearModel& terms_of(const SurveyProblem& problem) {
    return *find_linear_model(problem.options.robust_terms);
}

Score score_robust(const SurveyProblem& problem, const RowChoice& choice) {
    return score_robust_model(terms_of(problem), chosen_rows(problem.rows, choice.in_use),
                              problem.origin(), problem.options.priors);
}

FitResult fit_robust_rows(const SurveyProblem& problem, const RowChoice& choice) {
    const LinearModel& terms = terms_of(problem);
    const Priors& priors = problem.options.priors;
    auto applied = apply_model(terms, problem, choice, priors);
    if (auto* const refusal = std::get_if<Refusal>(&applied))
        return Refusal{fmt::format("terms {}: {}", terms.name, refusal->trouble), refusal->allowed};
    const std::vector<reading::SurveyRow> used = chosen_rows(problem.rows, choice.in_use);
    const auto robust = fit_robust_model(terms, used, problem.origin(), priors);
    if (!robust)
        return Refusal{fmt::format("{} rows with a reference are too few for {}, or too many of "
                                   "them are equal",
                                   used.size(), terms.name),
                       "more rows"};
    auto& fit = std::get<AppliedFit>(applied);
    fit.fit = robust->fit;
    fit.s_mgal = robust->s;
    Fit result;
    result.own = RobustPart{std::string(terms.name)};
    result.rows = uncorrected(problem, choice);
    result.score = score_robust(problem, choice);
    correct_rows(result, terms, fit, priors);
    Eigen::Index at = 0;
    for (CorrectedRow& row : result.rows) {
        // The robust scale hardly depends on a single row, so it is used as it is.
        row.studentised_residual.reset();
        const double share = row.is_used ? 1.0 - row.leverage.value() : 1.0 + row.leverage.value();
        if (row.residual && share > 0.0)
            row.studentised_residual = row.residual->value() / (robust->s * std::sqrt(share));
        if (row.is_used) row.own = RobustRow{robust->weights(at++)};
    }
    result.stations = average_stations(result, choice.accepted, fit, result.score.s_mgal);
    doubt_by_linear_fit(result.rows, terms, problem.origin(), priors);
    return result;
}

std::optional<Noise> robust_noise(const ChosenSurvey& survey, const Noise* nearby) {
    return linear_noise(terms_of(survey.problem), survey, nearby);
}

std::optional<residual::Residuals> robust_residuals(const ChosenSurvey& survey,
                                                    const Noise& noise) {
    return linear_residuals(terms_of(survey.problem), survey, noise);
}

}  // namespace

Model robust_model() {
    return {"robust", false, fit_robust_rows, score_robust, robust_noise, robust_residuals};
}

}  // namespace a351::corrector::model
