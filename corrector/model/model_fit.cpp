#include "corrector/model/model_fit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <utility>

#include "corrector/model/linear_terms.hpp"
#include "corrector/model/paper_correction.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector::model {
namespace {

Eigen::VectorXd as_vector(const std::vector<double>& values) {
    return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                             static_cast<Eigen::Index>(values.size()));
}

using ModelOf = std::function<const LinearModel*(const std::vector<reading::SurveyRow>&)>;

/// Returns the error (mGal) of each row, predicted without the rows of its station.  `model_of`
/// chooses the model for the remaining rows.
std::optional<std::vector<double>> station_left_out_mgal(
    const ModelOf& model_of, const std::vector<reading::SurveyRow>& rows, const TimeOrigin& origin,
    const Priors& priors) {
    std::vector<double> errors(rows.size());
    for (const std::string& station : station_names(rows)) {
        std::vector<reading::SurveyRow> others = rows;
        std::erase_if(others, [&](const reading::SurveyRow& row) { return row.site == station; });
        const LinearModel* const chosen = model_of(others);
        if (chosen == nullptr) return std::nullopt;
        const LinearModel model = with_scale(*chosen, priors);
        const auto fit = fit_model(model, others, origin, priors);
        if (!fit) return std::nullopt;
        const Eigen::MatrixXd columns = model_columns(model, rows, origin);
        const std::vector<double> differences = differences_mgal(rows);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (rows[i].site != station) continue;
            errors[i] =
                differences[i] - fit->at(columns.row(static_cast<Eigen::Index>(i)).transpose());
        }
    }
    return errors;
}

/// Returns the rms of the errors of station_left_out_mgal().
std::optional<double> left_out_stations_mgal(const ModelOf& model_of,
                                             const std::vector<reading::SurveyRow>& rows,
                                             const TimeOrigin& origin, const Priors& priors) {
    const auto errors = station_left_out_mgal(model_of, rows, origin, priors);
    if (!errors) return std::nullopt;
    double sum = 0.0;
    for (const double error : *errors) sum += error * error;
    return std::sqrt(sum / static_cast<double>(rows.size()));
}

/// Returns Error (2) of row `left_out`; line and drift are computed without this row.
std::optional<double> left_out_paper_error_mgal(std::vector<reading::SurveyRow> rows,
                                                std::vector<bool> in_use, std::size_t left_out,
                                                std::string_view base) {
    const reading::SurveyRow row = rows[left_out];
    rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(left_out));
    in_use.erase(in_use.begin() + static_cast<std::ptrdiff_t>(left_out));
    const auto line = fit_temperature_line(rows, in_use);
    if (!line) return std::nullopt;
    const DriftStep step =
        find_end_point_drift(rows, in_use, temperature_corrected_mgal(rows, *line), base);
    if (!step.drift) return std::nullopt;
    const std::vector<double> corrected1 = temperature_corrected_mgal({row}, *line);
    return errors_mgal({row}, drift_corrected_mgal({row}, corrected1, *step.drift)).front();
}

bool takes_part(const LinearModel& model, const std::vector<reading::SurveyRow>& rows,
                std::string_view base) {
    constexpr std::size_t kEnoughRows = 12;
    if (!(model.has_rate && model.has_time)) return true;
    std::set<int> base_stays;
    for (const reading::SurveyRow& row : rows)
        if (row.site == base) base_stays.insert(row.occupation);
    return base_stays.size() >= kFewestBaseStays || rows.size() >= kEnoughRows;
}

}  // namespace

std::vector<reading::SurveyRow> chosen_rows(const std::vector<reading::SurveyRow>& rows,
                                            const std::vector<bool>& chosen) {
    std::vector<reading::SurveyRow> result;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (chosen[i]) result.push_back(rows[i]);
    return result;
}

std::vector<std::string> station_names(const std::vector<reading::SurveyRow>& rows) {
    std::vector<std::string> names;
    for (const reading::SurveyRow& row : rows)
        if (std::ranges::find(names, row.site) == names.end()) names.push_back(row.site);
    return names;
}

const LinearModel* find_linear_model(std::string_view name) {
    for (const LinearModel& model : kLinearModels)
        if (model.name == name) return &model;
    for (const LinearModel& model : kModelsOnRequest)
        if (model.name == name) return &model;
    return nullptr;
}

LinearModel with_scale(LinearModel model, const Priors& priors) {
    model.has_scale = priors.find(kScale) != nullptr;
    return model;
}

std::size_t LinearModel::parameter_count() const { return 1 + terms_of(*this).size(); }

Eigen::MatrixXd model_columns(const LinearModel& model, const std::vector<reading::SurveyRow>& rows,
                              const TimeOrigin& origin) {
    const std::vector<LinearTerm> terms = terms_of(model);
    Eigen::MatrixXd columns(static_cast<Eigen::Index>(rows.size()),
                            std::ssize(terms) + std::ssize(origin.steps));
    for (Eigen::Index i = 0; i < columns.rows(); ++i) {
        const reading::SurveyRow& row = rows[static_cast<std::size_t>(i)];
        Eigen::Index k = 0;
        for (const LinearTerm& term : terms) columns(i, k++) = term.column(model, row, origin);
        for (const Step& step : origin.steps) columns(i, k++) = step.is_before(row) ? 1.0 : 0.0;
    }
    return columns;
}

std::vector<std::string> coefficient_names(const LinearModel& model, std::size_t steps) {
    std::vector<std::string> names{"constant_mgal"};
    for (const LinearTerm& term : terms_of(model)) names.emplace_back(term.name);
    for (std::size_t k = 1; k <= steps; ++k) names.push_back(fmt::format("step_{}_mgal", k));
    return names;
}

SlopePriors slope_priors(const LinearModel& model, const Priors& priors, std::size_t steps) {
    const std::vector<std::string> names = coefficient_names(model, steps);
    const auto slope_count = static_cast<Eigen::Index>(names.size()) - 1;
    SlopePriors slopes{Eigen::VectorXd::Zero(slope_count), Eigen::VectorXd::Zero(slope_count),
                       priors.reading_sd_mgal};
    for (Eigen::Index k = 0; k < slope_count; ++k) {
        const Prior* const prior = priors.find(names[static_cast<std::size_t>(k) + 1]);
        if (prior == nullptr) continue;
        const std::string& name = names[static_cast<std::size_t>(k) + 1];
        // The slope of the scale is k.
        slopes.values(k) = name == kScale ? prior->mean - 1.0 : prior->mean;
        slopes.weights(k) = priors.reading_sd_mgal / priors.in_use(name, *prior).sd;
    }
    return slopes;
}

std::optional<LinearFit> fit_model(const LinearModel& model,
                                   const std::vector<reading::SurveyRow>& rows,
                                   const TimeOrigin& origin, const Priors& priors) {
    if (rows.empty()) return std::nullopt;
    return fit_linear(model_columns(model, rows, origin), as_vector(differences_mgal(rows)),
                      slope_priors(model, priors, origin.steps.size()));
}

Score score_linear_model(const LinearModel& model, const std::vector<reading::SurveyRow>& rows,
                         const TimeOrigin& origin, const Priors& priors) {
    Score score;
    score.model = model.name;
    score.row_count = rows.size();
    score.parameter_count = model.parameter_count() + origin.steps.size();
    const auto fit = fit_model(model, rows, origin, priors);
    if (!fit) return score;

    const auto n = static_cast<double>(score.row_count);
    const auto k = static_cast<double>(score.parameter_count + 1);
    score.rms_mgal = std::sqrt(fit->rss / n);
    score.dof = static_cast<std::size_t>(fit->dof());
    score.s_mgal = fit->residual_scale();
    if (score.s_mgal) {
        // Leave-one-out error r / (1 - h), exact for least squares.
        const Eigen::ArrayXd left_out = fit->residuals.array() / (1.0 - fit->leverages.array());
        score.loo_mgal = std::sqrt(left_out.square().sum() / n);
        if (!std::isfinite(*score.loo_mgal)) score.loo_mgal.reset();
    }
    // AICc = n ln(RSS/n) + 2K + 2K(K+1)/(n-K-1)   (Hurvich and Tsai 1989)
    if (n - k - 1.0 > 0.0 && fit->rss > 0.0 && fit->prior_count == 0)
        score.aicc = n * std::log(fit->rss / n) + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0);
    score.loso_mgal =
        left_out_stations_mgal([&model](const auto&) { return &model; }, rows, origin, priors);
    return score;
}

Score score_paper_model(const std::vector<reading::SurveyRow>& rows,
                        const std::vector<bool>& in_use, std::string_view base) {
    Score score;
    score.model = "paper";
    score.row_count = static_cast<std::size_t>(std::ranges::count(in_use, true));
    score.parameter_count = 4;  // slope, intercept, and the errors at both ends of the drift
    const auto line = fit_temperature_line(rows, in_use);
    if (!line) return score;
    const std::vector<double> corrected1 = temperature_corrected_mgal(rows, *line);
    score.rms_before_drift_mgal = rms(errors_mgal(rows, corrected1), in_use).value();
    const DriftStep step = find_end_point_drift(rows, in_use, corrected1, base);
    if (!step.drift) return score;
    const auto n = static_cast<double>(score.row_count);
    score.dof = score.row_count - std::min(score.row_count, score.parameter_count);
    const std::vector<double> corrected2 = drift_corrected_mgal(rows, corrected1, *step.drift);
    score.rms_mgal = rms(errors_mgal(rows, corrected2), in_use).value();
    if (score.dof > 0)
        score.s_mgal = *score.rms_mgal * std::sqrt(n / static_cast<double>(score.dof));

    double sum = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!in_use[i]) continue;
        const auto error = left_out_paper_error_mgal(rows, in_use, i, base);
        if (!error) return score;
        sum += *error * *error;
    }
    score.loo_mgal = std::sqrt(sum / n);
    return score;
}

std::optional<std::vector<double>> left_out_errors_mgal(const LinearModel& model,
                                                        const std::vector<reading::SurveyRow>& rows,
                                                        const TimeOrigin& origin,
                                                        const Priors& priors) {
    return station_left_out_mgal([&model](const auto&) { return &model; }, rows, origin, priors);
}

std::optional<Interval> bootstrap_rms_interval(const std::vector<double>& errors,
                                               const std::vector<std::string>& stations,
                                               std::uint64_t seed) {
    std::vector<double> squares;
    for (const double error : errors) squares.push_back(error * error);
    auto interval = bootstrap_mean_interval(squares, stations, seed);
    if (interval) interval = Interval{std::sqrt(interval->low), std::sqrt(interval->high)};
    return interval;
}

std::optional<Interval> bootstrap_mean_interval(const std::vector<double>& values,
                                                const std::vector<std::string>& stations,
                                                std::uint64_t seed) {
    struct Station {
        std::string name;
        double sum = 0.0;
        double count = 0.0;
    };
    std::vector<Station> sums;
    for (std::size_t i = 0; i < values.size(); ++i) {
        auto at = std::ranges::find(sums, stations[i], &Station::name);
        if (at == sums.end()) at = sums.insert(sums.end(), {stations[i]});
        at->sum += values[i];
        at->count += 1.0;
    }
    if (sums.size() < 2) return std::nullopt;

    // The distributions of <random> differ between libraries; the generator is the same everywhere.
    std::mt19937_64 generator(seed);
    std::vector<double> means;
    for (int draw = 0; draw < kBootstrapDraws; ++draw) {
        double sum = 0.0;
        double count = 0.0;
        for (std::size_t k = 0; k < sums.size(); ++k) {
            const Station& station = sums[generator() % sums.size()];
            sum += station.sum;
            count += station.count;
        }
        means.push_back(sum / count);
    }
    std::ranges::sort(means);
    // Values outside either limit: 2.5 % of the draws.
    constexpr auto kTail = static_cast<std::size_t>(kBootstrapDraws / 40);
    return Interval{means[kTail], means[means.size() - 1 - kTail]};
}

std::optional<Choice> choose_model(const std::vector<reading::SurveyRow>& rows,
                                   const TimeOrigin& origin, std::string_view base,
                                   const Priors& priors) {
    std::vector<Score> scores;
    for (const LinearModel& model : kLinearModels) {
        if (!takes_part(model, rows, base)) continue;
        Score score = score_linear_model(with_scale(model, priors), rows, origin, priors);
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

std::optional<double> choice_loso_mgal(const std::vector<reading::SurveyRow>& rows,
                                       const TimeOrigin& origin, std::string_view base,
                                       const Priors& priors) {
    const ModelOf chosen =
        [&](const std::vector<reading::SurveyRow>& others) -> const LinearModel* {
        const auto choice = choose_model(others, origin, base, priors);
        return choice ? find_linear_model(choice->model) : nullptr;
    };
    return left_out_stations_mgal(chosen, rows, origin, priors);
}

}  // namespace a351::corrector::model
