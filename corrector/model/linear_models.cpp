#include <memory>

#include "corrector/model/applied_fit.hpp"
#include "corrector/model/row_doubts.hpp"

namespace a351::corrector {
namespace {

/// Returns the 95 % interval of the LOO, from the leave-one-out errors r / (1 - h), which are exact
/// for least squares.
std::optional<Interval> loo_interval(const ModelFit& result, std::uint64_t seed) {
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

class Linear final : public Model {
public:
    Linear(const LinearModel& terms, bool is_always_scored)
        : terms_(terms), is_always_scored_(is_always_scored) {}

    [[nodiscard]] std::string_view name() const override { return terms_.name; }
    [[nodiscard]] bool is_always_scored() const override { return is_always_scored_; }

    [[nodiscard]] std::variant<ModelFit, Refusal> fit(const SurveyProblem& problem,
                                                      const RowChoice& choice) const override {
        const ModelPriors& priors = problem.options.priors;
        auto applied = apply_model(terms_, problem, choice, priors);
        if (auto* const refusal = std::get_if<Refusal>(&applied)) return std::move(*refusal);
        const auto& fit = std::get<AppliedFit>(applied);
        ModelFit result;
        result.rows = uncorrected(problem, choice);
        result.score = *score(problem, choice);
        correct_rows(result, terms_, fit);
        result.own = LinearPart{loo_interval(result, problem.options.seed)};
        result.stations = average_stations(result, choice.accepted, fit, result.score.s_mgal);
        doubt_by_linear_fit(result.rows, terms_, priors);
        return result;
    }

    [[nodiscard]] std::optional<ModelScore> score(const SurveyProblem& problem,
                                                  const RowChoice& choice) const override {
        return score_linear_model(terms_, chosen_rows(problem.rows, choice.in_use),
                                  problem.origin(), problem.options.priors);
    }

private:
    const LinearModel& terms_;
    bool is_always_scored_;
};

}  // namespace

const std::vector<const Model*>& linear_models() {
    static const std::vector<std::unique_ptr<const Model>> owned = [] {
        std::vector<std::unique_ptr<const Model>> list;
        for (const LinearModel& terms : kLinearModels)
            list.push_back(std::make_unique<Linear>(terms, true));
        for (const LinearModel& terms : kModelsOnRequest)
            list.push_back(std::make_unique<Linear>(terms, false));
        return list;
    }();
    static const std::vector<const Model*> all = [] {
        std::vector<const Model*> list;
        for (const auto& model : owned) list.push_back(model.get());
        return list;
    }();
    return all;
}

}  // namespace a351::corrector
