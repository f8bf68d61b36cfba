#include "corrector/model/applied_fit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <utility>

#include "corrector/model/linear_terms.hpp"
#include "corrector/model/outlier_tests.hpp"
#include "corrector/model/paper_correction.hpp"

namespace a351::corrector::model {

namespace {

/// Returns the column of the scale.
Eigen::Index scale_column(const LinearModel& model) {
    return static_cast<Eigen::Index>(model.parameter_count()) - 2;
}

/// Sets the gravity in the column of the scale, for rows that are not in the fit, to the one that they
/// get: reading - effects = g + k (g - g0), so g - g0 = (reading - effects - g0) / (1 + k).
void set_unknown_gravity(AppliedFit& applied, const LinearModel& model,
                         const SurveyProblem& problem, const RowChoice& choice) {
    const Eigen::Index at = scale_column(model);
    const double k = applied.fit.coefficients(at + 1);
    for (std::size_t i = 0; i < problem.rows.size(); ++i) {
        if (choice.in_use[i]) continue;
        double& above_mgal = applied.columns(static_cast<Eigen::Index>(i), at);
        const reading::SurveyRow& row = problem.rows[i];
        const double effects_mgal = applied.fit.at(applied.regressors_of(i)) - k * above_mgal;
        above_mgal =
            ((row.acceleration - row.tide).value() - effects_mgal - kMilliGalPerStandardGravity) /
            (1.0 + k);
    }
}

/// Makes the coefficient k the scale 1 + k, and reports it.
void set_scale(Fit& result, const LinearModel& model, const Priors& priors) {
    const auto at = static_cast<std::size_t>(scale_column(model)) + 1;
    const Prior prior = priors.scale_of("");
    Coefficient& coefficient = result.coefficients.at(at);
    coefficient.value += 1.0;
    coefficient.prior = prior;
    result.scales.push_back(
        {"", coefficient.value, coefficient.standard_error.value_or(prior.sd), prior});
}

}  // namespace

std::variant<AppliedFit, Refusal> apply_model(const LinearModel& model,
                                              const SurveyProblem& problem, const RowChoice& choice,
                                              const Priors& priors) {
    const std::vector<reading::SurveyRow> used = chosen_rows(problem.rows, choice.in_use);
    auto fit = fit_model(model, used, problem.origin(), priors);
    if (!fit)
        return Refusal{fmt::format("{} rows with a reference do not determine it", used.size()),
                       fmt::format("at least {} rows between which temperature, rate and time vary "
                                   "independently{}",
                                   model.parameter_count() - (model.has_scale ? 1U : 0U) +
                                       problem.options.steps.size(),
                                   problem.options.steps.empty() ? "" : ", some after each step")};
    const auto s_mgal = fit->residual_scale();
    AppliedFit applied{std::move(*fit), model_columns(model, problem.rows, problem.origin()),
                       s_mgal};
    if (model.has_scale) set_unknown_gravity(applied, model, problem, choice);
    return applied;
}

std::optional<Noise> linear_noise(const LinearModel& model, const ChosenSurvey& survey,
                                  const Noise* /*nearby*/) {
    const auto fit = fit_model(model, chosen_rows(survey.problem.rows, survey.choice.in_use),
                               survey.problem.origin(), survey.problem.options.priors);
    if (!fit) return std::nullopt;
    const auto s_mgal = fit->residual_scale();
    if (!s_mgal || !(*s_mgal > 0.0)) return std::nullopt;
    return *s_mgal;
}

std::optional<residual::Residuals> linear_residuals(const LinearModel& model,
                                                    const ChosenSurvey& survey,
                                                    const Noise& noise) {
    const std::vector<reading::SurveyRow>& rows = survey.problem.rows;
    const TimeOrigin origin = survey.problem.origin();
    const Priors& priors = survey.problem.options.priors;
    const std::vector<reading::SurveyRow> used = chosen_rows(rows, survey.choice.in_use);
    if (!fit_model(model, used, origin, priors)) return std::nullopt;
    const double s_mgal = std::get<double>(noise);
    const Eigen::MatrixXd columns = model_columns(model, used, origin);
    const SlopePriors slopes = slope_priors(model, priors, origin.steps.size());
    const auto prior_count = static_cast<Eigen::Index>((slopes.weights.array() > 0.0).count());
    // Rows of the readings, then rows of the priors; their constant is 0.
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(columns.rows() + prior_count, columns.cols() + 1);
    Eigen::VectorXd y = Eigen::VectorXd::Zero(a.rows());
    // The noise is that of the readings: priors keep their standard deviations.
    const double of_prior = s_mgal / slopes.row_sd;
    a.col(0).head(columns.rows()).setOnes();
    a.topRightCorner(columns.rows(), columns.cols()) = columns;
    const std::vector<double> differences = differences_mgal(used);
    std::ranges::copy(differences, y.begin());
    for (Eigen::Index k = 0, row = columns.rows(); k < slopes.weights.size(); ++k) {
        if (!(slopes.weights(k) > 0.0)) continue;
        a(row, k + 1) = of_prior * slopes.weights(k);
        y(row++) = of_prior * slopes.weights(k) * slopes.values(k);
    }
    std::vector<std::size_t> readings;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (survey.choice.in_use[i]) readings.push_back(i);
    readings.resize(static_cast<std::size_t>(a.rows()), rows.size());
    return residual::residuals_of(a / s_mgal, y / s_mgal, readings,
                                  Eigen::VectorXd::Constant(a.rows(), 1.0 / s_mgal), rows.size());
}

void set_uncertainty(CorrectedRow& out, const AppliedFit& applied, std::size_t row,
                     std::optional<double> s_mgal) {
    const Eigen::VectorXd x = applied.regressors_of(row);
    out.leverage = applied.fit.leverage_at(x);
    // u^2 = s^2 + var(fit(x))
    if (s_mgal)
        out.u_corrected =
            MilliGal(std::sqrt(*s_mgal * *s_mgal + applied.fit.variance_at(x, *s_mgal)));
}

void correct_rows(Fit& result, const LinearModel& model, const AppliedFit& applied,
                  const Priors& priors) {
    const LinearFit& fit = applied.fit;
    const std::vector<LinearTerm> terms = terms_of(model);
    const auto steps = static_cast<std::size_t>(fit.coefficients.size()) - 1 - terms.size();
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        CorrectedRow& out = result.rows[i];
        const Eigen::VectorXd x = applied.regressors_of(i);
        const auto effect = [&](Eigen::Index k) {
            return MilliGal(fit.coefficients(k + 1) * x(k));
        };
        Eigen::Index k = 0;
        out.temperature_correction = -MilliGal(fit.coefficients(0));
        for (const LinearTerm& term : terms) term.correct(out, effect(k++));
        while (k < x.size()) out.drift_correction = out.drift_correction - effect(k++);
        out.corrected = out.row.acceleration - out.row.tide - MilliGal(fit.at(x));
        if (out.row.reference) out.residual = *out.row.reference - out.corrected;
        set_uncertainty(out, applied, i, applied.s_mgal);
        if (out.residual)
            out.studentised_residual =
                studentised_residual(out.residual->value(), out.leverage.value(), out.is_used, fit);
    }
    const std::vector<std::string> names = coefficient_names(model, steps);
    std::optional<Eigen::VectorXd> variances;
    if (applied.s_mgal) variances = fit.covariance(*applied.s_mgal).diagonal();
    for (std::size_t k = 0; k < names.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        result.coefficients.push_back({names[k], fit.coefficients(at), std::nullopt});
        if (const Prior* const prior = priors.find(names[k]))
            result.coefficients.back().prior = *prior;
        if (variances) result.coefficients.back().standard_error = std::sqrt((*variances)(at));
    }
    if (model.has_scale) set_scale(result, model, priors);
}

std::vector<StationValue> average_stations(const Fit& result, const std::vector<bool>& accepted,
                                           const AppliedFit& applied,
                                           std::optional<double> s_mgal) {
    const std::vector<CorrectedRow>& rows = result.rows;
    std::vector<StationValue> stations;
    for (const CorrectedRow& first : rows) {
        const std::string& site = first.row.site;
        if (std::ranges::find(stations, site, &StationValue::site) != stations.end()) continue;
        StationValue station;
        station.site = site;
        station.reference = first.row.reference;
        station.is_flagged_only = true;
        for (std::size_t i = 0; i < rows.size(); ++i)
            if (rows[i].row.site == site && accepted[i]) station.is_flagged_only = false;
        double sum = 0.0;
        Eigen::VectorXd x = Eigen::VectorXd::Zero(applied.columns.cols());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (rows[i].row.site != site) continue;
            if (rows[i].is_used)
                station.redundancy =
                    station.redundancy.value_or(0.0) + 1.0 - rows[i].leverage.value();
            if (!station.is_flagged_only && !accepted[i]) continue;
            ++station.row_count;
            sum += rows[i].corrected.value();
            x += applied.regressors_of(i);
        }
        const auto n = static_cast<double>(station.row_count);
        station.gravity = MilliGal(sum / n);
        // u^2 = s^2 / n + var(fit(mean of its rows))
        if (s_mgal) {
            const auto dof = static_cast<double>(applied.fit.dof());
            station.u_gravity = MilliGal(
                std::sqrt(*s_mgal * *s_mgal / n + applied.fit.variance_at(x / n, *s_mgal)));
            if (dof > 0.0) {
                station.dof = dof;
                station.coverage_factor =
                    boost::math::quantile(boost::math::students_t(dof), 0.975);
            }
        }
        if (station.reference) station.residual = *station.reference - station.gravity;
        stations.push_back(std::move(station));
    }
    return stations;
}

}  // namespace a351::corrector::model
