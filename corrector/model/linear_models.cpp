#include <functional>

#include "corrector/model/applied_fit.hpp"
#include "corrector/model/left_out_stations.hpp"
#include "corrector/model/model.hpp"
#include "corrector/model/row_doubts.hpp"

namespace a351::corrector::model {
namespace {

/// Returns the 95 % interval of the LOO, from the leave-one-out errors r / (1 - h), which are exact
/// for least squares.
std::optional<Interval> loo_interval(const Fit& result, std::uint64_t seed) {
    if (!result.score.loo_mgal) return std::nullopt;
    std::vector<double> errors;
    std::vector<std::string> stations;
    for (const CorrectedRow& row : result.rows) {
        if (!row.is_used) continue;
        errors.push_back(row.residual->value() / (1.0 - row.leverage.value()));
        stations.push_back(row.row.site);
    }
    return bootstrap_rms_interval(errors, stations, seed);
}

Score score(const LinearModel& terms, const SurveyProblem& problem, const RowChoice& choice) {
    return score_linear_model(terms, chosen_rows(problem.rows, choice.in_use), problem.origin(),
                              problem.options.priors);
}

FitResult fit(const LinearModel& terms, const SurveyProblem& problem, const RowChoice& choice) {
    const Priors& priors = problem.options.priors;
    auto applied = apply_model(terms, problem, choice, priors);
    if (auto* const refusal = std::get_if<Refusal>(&applied)) return std::move(*refusal);
    const auto& linear = std::get<AppliedFit>(applied);
    Fit result;
    result.rows = uncorrected(problem, choice);
    result.score = score(terms, problem, choice);
    correct_rows(result, terms, linear);
    result.own = LinearPart{loo_interval(result, problem.options.seed)};
    result.stations = average_stations(result, choice.accepted, linear, result.score.s_mgal);
    set_left_out_stations(result, terms, problem, choice);
    doubt_by_linear_fit(result.rows, terms, priors);
    return result;
}

}  // namespace

std::vector<Model> linear_models() {
    std::vector<Model> list;
    const auto add = [&list](const LinearModel& terms, bool is_always_scored) {
        list.push_back({terms.name, is_always_scored, std::bind_front(fit, terms),
                        std::bind_front(score, terms)});
    };
    for (const LinearModel& terms : kLinearModels) add(terms, true);
    for (const LinearModel& terms : kModelsOnRequest) add(terms, false);
    return list;
}

}  // namespace a351::corrector::model
