#include "corrector/model/linear_models.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "corrector/model/adjusted_fit.hpp"

namespace a351::corrector::model {
namespace {

using adjustment::AdjustedSurvey;

using ModelOf = std::function<const LinearModel*(const std::vector<bool>& in_use)>;

/// Returns the rows in use without those of one or two stations.
std::vector<bool> without_stations(const SurveyProblem& problem, std::vector<bool> in_use,
                                   const std::string& a, const std::string& b) {
    for (std::size_t i = 0; i < in_use.size(); ++i)
        if (problem.rows[i].site == a || problem.rows[i].site == b) in_use[i] = false;
    return in_use;
}

adjustment::SurveyEquations equations_of(const LinearModel& model, const SurveyProblem& problem,
                                         const std::vector<bool>& in_use, bool is_exact) {
    adjustment::Design design{std::string(model.name), model.terms, false, is_exact};
    if (problem.options.priors.find(adjustment::kScale) != nullptr)
        design.terms.push_back(&adjustment::kScaleTerm);
    return {problem.rows,
            in_use,
            std::move(design),
            {problem.options.datum, problem.options.priors, problem.options.steps, {}}};
}

/// Returns reading - tide - effects - reference of a row, mGal: the error of its prediction, with the
/// sign of the reading.
double difference_left_mgal(const AdjustedSurvey& adjusted, std::size_t row) {
    const reading::SurveyRow& of = adjusted.survey.rows()[row];
    double left = (of.acceleration - *of.reference - of.tide).value();
    for (const adjustment::Entry& part : adjusted.survey.effects(row))
        left -= adjusted.effect_mgal(part);
    return left;
}

/// Returns the errors of rows without their station; `model_of` chooses the model for the others.
std::optional<std::vector<double>> station_left_out_mgal(const ModelOf& model_of,
                                                         const SurveyProblem& problem,
                                                         const std::vector<bool>& in_use) {
    std::vector<double> errors(in_use.size());
    for (const std::string& station : station_names(problem.rows, in_use)) {
        const std::vector<bool> others = without_stations(problem, in_use, station, station);
        const LinearModel* const chosen = model_of(others);
        if (chosen == nullptr) return std::nullopt;
        const AdjustedSurvey adjusted = adjust_linear(*chosen, problem, others);
        if (!adjusted.is_determined() || adjusted.survey.readings().empty()) return std::nullopt;
        for (std::size_t i = 0; i < in_use.size(); ++i)
            if (in_use[i] && problem.rows[i].site == station)
                errors[i] = difference_left_mgal(adjusted, i);
    }
    std::vector<double> of_used;
    for (std::size_t i = 0; i < in_use.size(); ++i)
        if (in_use[i]) of_used.push_back(errors[i]);
    return of_used;
}

bool has_term(const LinearModel& model, const adjustment::Term& term) {
    return std::ranges::find(model.terms, &term) != model.terms.end();
}

bool takes_part(const LinearModel& model, const SurveyProblem& problem,
                const std::vector<bool>& in_use) {
    constexpr std::ptrdiff_t kEnoughRows = 12;
    if (!(has_term(model, adjustment::kRate) && has_term(model, adjustment::kTime))) return true;
    std::set<int> base_stays;
    for (std::size_t i = 0; i < in_use.size(); ++i)
        if (in_use[i] && problem.rows[i].site == problem.options.base)
            base_stays.insert(problem.rows[i].occupation);
    return base_stays.size() >= kFewestBaseStays || std::ranges::count(in_use, true) >= kEnoughRows;
}

FitResult fit(const LinearModel& model, const SurveyProblem& problem, const RowChoice& choice) {
    const AdjustedSurvey adjusted = adjust_linear(model, problem, choice.in_use);
    if (!adjusted.is_determined())
        return Refusal{fmt::format("{} rows with a reference do not determine it",
                                   std::ranges::count(choice.in_use, true)),
                       fmt::format("at least {} rows between which temperature, rate and time vary "
                                   "independently{}",
                                   model.terms.size() + problem.options.steps.size(),
                                   problem.options.steps.empty() ? "" : ", some after each step")};
    Fit result = fit_of(adjusted, problem, choice);
    result.score = score_linear_model(model, problem, choice.in_use);
    set_loo_interval(result, problem.options.seed);
    const auto without = [&](const std::string& a, const std::string& b) {
        return adjust_linear(model, problem, without_stations(problem, choice.in_use, a, b));
    };
    set_left_out_stations(result, adjusted, choice, without);
    return result;
}

std::unique_ptr<adjustment::Trials> trials(const LinearModel& model, const SurveyProblem& problem,
                                           const RowChoice& choice) {
    AdjustedSurvey adjusted = adjust_linear(model, problem, choice.in_use);
    if (!adjusted.is_determined()) return nullptr;
    return adjustment::white_trials(std::move(adjusted));
}

/// Fewest degrees of freedom with which the noise of a survey is known for a joint adjustment.
/// Reason: with 2 the expected variance is infinite.
constexpr std::size_t kFewestJointDof = 3;

/// Returns Model::joint: the references are unknowns, as the joint adjustment holds them itself.
///
/// The noise has the expected variance s^2 dof / (dof - 2), that of Student's t: with few degrees of
/// freedom a survey whose readings agree by chance would outweigh all others.
/// Source: JCGM 101:2008, 6.4.9.4.
std::optional<AdjustedSurvey> joint(const LinearModel& model, const SurveyProblem& problem,
                                    const RowChoice& choice) {
    const AdjustedSurvey own = adjust_linear(model, problem, choice.in_use);
    const std::size_t dof = own.adjustment.dof();
    if (!own.is_determined() || dof < kFewestJointDof) return std::nullopt;
    adjustment::SurveyEquations survey = equations_of(model, problem, choice.accepted, false);
    // Readings that a line fits exactly keep the resolution of the tables.
    const double reading_sd_mgal = problem.options.priors.reading_sd_mgal;
    survey.set_noise(std::max(
        *own.adjustment.s0() * std::sqrt(static_cast<double>(dof) / static_cast<double>(dof - 2)),
        adjustment::kLeastSd_mgal / reading_sd_mgal));
    AdjustedSurvey adjusted = adjustment::adjust(std::move(survey), adjustment::Cofactor::left_out);
    if (!adjusted.is_determined() || adjusted.moved_mgal > adjustment::kSettled_mgal)
        return std::nullopt;
    return adjusted;
}

}  // namespace

const std::vector<LinearModel>& compared_models() {
    using namespace adjustment;
    static const std::vector<LinearModel> list{
        {"t", {&kConstant, &kTemperature}},
        {"t-rate", {&kConstant, &kTemperature, &kRate}},
        {"t-drift", {&kConstant, &kTemperature, &kTime}},
        {"t-rate-drift", {&kConstant, &kTemperature, &kRate, &kTime}}};
    return list;
}

const std::vector<LinearModel>& models_on_request() {
    using namespace adjustment;
    static const std::vector<LinearModel> list{
        {"t-rate-drift-axes", {&kConstant, &kTemperature, &kRate, &kTime, &kAxisX, &kAxisY}},
        {"drift", {&kConstant, &kTime}}};
    return list;
}

const LinearModel* find_linear_model(std::string_view name) {
    for (const auto* const list : {&compared_models(), &models_on_request()})
        for (const LinearModel& model : *list)
            if (model.name == name) return &model;
    return nullptr;
}

AdjustedSurvey adjust_linear(const LinearModel& model, const SurveyProblem& problem,
                             const std::vector<bool>& in_use) {
    return adjustment::adjust(equations_of(model, problem, in_use, true));
}

Score score_linear_model(const LinearModel& model, const SurveyProblem& problem,
                         const std::vector<bool>& in_use) {
    const AdjustedSurvey adjusted = adjust_linear(model, problem, in_use);
    const adjustment::Adjustment& solution = adjusted.adjustment;
    Score score;
    score.model = model.name;
    score.row_count = adjusted.survey.readings().size();
    score.parameter_count = adjusted.survey.terms().size();
    if (!adjusted.is_determined() || score.row_count == 0) return score;

    const auto n = static_cast<double>(score.row_count);
    const auto k = static_cast<double>(score.parameter_count + 1);
    double rss = 0.0, left_out = 0.0;
    for (std::size_t i = 0; i < score.row_count; ++i) {
        const double residual = solution.residual(i);
        rss += residual * residual;
        left_out += std::pow(residual / solution.redundancy(i), 2);
    }
    score.rms_mgal = std::sqrt(rss / n);
    score.dof = solution.dof();
    if (const auto s0 = solution.s0()) {
        score.s_mgal = *s0 * problem.options.priors.reading_sd_mgal;
        // Leave-one-out error r / (1 - h), exact for least squares.
        score.loo_mgal = std::sqrt(left_out / n);
        if (!std::isfinite(*score.loo_mgal)) score.loo_mgal.reset();
    }
    // AICc = n ln(RSS/n) + 2K + 2K(K+1)/(n-K-1)   (Hurvich and Tsai 1989)
    const bool has_prior = solution.equations().rows.size() > score.row_count;
    if (n - k - 1.0 > 0.0 && rss > 0.0 && !has_prior)
        score.aicc = n * std::log(rss / n) + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0);
    if (const auto errors_mgal = left_out_errors_mgal(model, problem, in_use))
        score.loso_mgal = root_mean_square(*errors_mgal);
    return score;
}

std::optional<std::vector<double>> left_out_errors_mgal(const LinearModel& model,
                                                        const SurveyProblem& problem,
                                                        const std::vector<bool>& in_use) {
    return station_left_out_mgal([&model](const auto&) { return &model; }, problem, in_use);
}

std::optional<Choice> choose_model(const SurveyProblem& problem, const std::vector<bool>& in_use) {
    std::vector<Score> scores;
    for (const LinearModel& model : compared_models()) {
        if (!takes_part(model, problem, in_use)) continue;
        Score score = score_linear_model(model, problem, in_use);
        if (score.loso_mgal && score.row_count >= score.parameter_count + kFewestChoiceDof)
            scores.push_back(score);
    }
    if (scores.empty()) return std::nullopt;
    const Score& best = *std::ranges::min_element(scores, {}, &Score::loso_mgal);
    // Limit: LOSO (1 + 1 / sqrt(2 (n - p))).
    const auto dof = static_cast<double>(best.row_count - best.parameter_count);
    const double limit = *best.loso_mgal * (1.0 + 1.0 / std::sqrt(2.0 * dof));
    const auto rank = [](const Score& score) {
        return std::pair(score.parameter_count, *score.loso_mgal);
    };
    const Score* chosen = &best;
    for (const Score& score : scores)
        if (*score.loso_mgal <= limit && rank(score) < rank(*chosen)) chosen = &score;
    return Choice{chosen->model, limit};
}

std::optional<double> choice_loso_mgal(const SurveyProblem& problem,
                                       const std::vector<bool>& in_use) {
    const ModelOf chosen = [&](const std::vector<bool>& others) -> const LinearModel* {
        const auto choice = choose_model(problem, others);
        return choice ? find_linear_model(choice->model) : nullptr;
    };
    const auto errors_mgal = station_left_out_mgal(chosen, problem, in_use);
    return errors_mgal ? root_mean_square(*errors_mgal) : std::nullopt;
}

std::vector<Model> linear_models() {
    std::vector<Model> list;
    const auto add = [&list](const LinearModel& model, bool is_always_scored) {
        list.push_back({model.name, is_always_scored, false, std::bind_front(fit, model),
                        [model](const SurveyProblem& problem, const RowChoice& choice) {
                            return score_linear_model(model, problem, choice.in_use);
                        },
                        std::bind_front(trials, model), std::bind_front(joint, model)});
    };
    for (const LinearModel& model : compared_models()) add(model, true);
    for (const LinearModel& model : models_on_request()) add(model, false);
    return list;
}

}  // namespace a351::corrector::model
