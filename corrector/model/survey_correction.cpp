#include "corrector/model/survey_correction.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "corrector/model/calibration_use.hpp"
#include "corrector/model/day_correction.hpp"
#include "corrector/model/network_correction.hpp"
#include "corrector/model/outlier_tests.hpp"
#include "corrector/model/paper_correction.hpp"
#include "corrector/model/robust_fit.hpp"
#include "corrector/model/row_doubts.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::corrector {
namespace {

void require_row_of(const std::vector<SurveyRow>& rows, const std::string& site, const char* role) {
    const std::vector<std::string> known = station_names(rows);
    if (std::ranges::find(known, site) == known.end())
        throw InputError(fmt::format("{} = {}: no occupation of this site; allowed: {}", role, site,
                                     text::joined(known)));
}

/// Returns true if a row may enter a fit; flags are not considered.
bool is_datum(const SurveyRow& row, const std::vector<std::string>& datum) {
    return row.reference && !row.is_excluded &&
           (datum.empty() || std::ranges::find(datum, row.site) != datum.end());
}

ScoredRowSet score_all_models(const std::string& name, const std::vector<SurveyRow>& rows,
                              const std::vector<bool>& in_use, const SurveyOptions& options) {
    ScoredRowSet set{name, {score_paper_model(rows, in_use, options.base)}};
    const std::vector<SurveyRow> used = chosen_rows(rows, in_use);
    for (const LinearModel& model : kLinearModels)
        set.scores.push_back(score_linear_model(model, used, rows.front().time, options.priors));
    return set;
}

/// A fit, applied to every row, in use or not.
struct Applied {
    LinearFit fit;
    Eigen::MatrixXd columns;       ///< (n, p - 1) Regressors of all rows.
    std::optional<double> s_mgal;  ///< Standard deviation of a row.
};

Applied apply_model(const LinearModel& model, const std::vector<SurveyRow>& rows,
                    const std::vector<SurveyRow>& used, UtcTime origin, const ModelPriors& priors) {
    auto fit = fit_model(model, used, origin, priors);
    if (!fit)
        throw InputError(
            fmt::format("model = {}: {} rows with a reference do not determine it; allowed: at "
                        "least {} rows between which temperature, rate and time vary independently",
                        model.name, used.size(), model.parameter_count()));
    const auto s_mgal = fit->residual_scale();
    return {std::move(*fit), model_columns(model, rows, origin), s_mgal};
}

void set_uncertainty(CorrectedRow& out, const LinearFit& fit, std::optional<double> s_mgal,
                     const Eigen::VectorXd& x) {
    const double leverage = fit.leverage_at(x);
    out.leverage = leverage;
    // u = s sqrt(1 + h): a station that is not in the fit
    if (s_mgal) out.u_corrected = MilliGal(*s_mgal * std::sqrt(1.0 + leverage));
}

void correct_linear(SurveyCorrection& result, const LinearModel& model, const Applied& applied) {
    const LinearFit& fit = applied.fit;
    const auto s = applied.s_mgal;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        CorrectedRow& out = result.rows[i];
        const auto at = static_cast<Eigen::Index>(i);
        const auto effect = [&](Eigen::Index k) {
            return MilliGal(fit.coefficients(k + 1) * applied.columns(at, k));
        };
        const Eigen::VectorXd x = applied.columns.row(at).transpose();
        Eigen::Index k = 0;
        out.temperature_correction = -MilliGal(fit.coefficients(0));
        if (model.has_temperature)
            out.temperature_correction = -(MilliGal(fit.coefficients(0)) + effect(k++));
        if (model.has_rate) out.rate_correction = -effect(k++);
        if (model.has_time) out.drift_correction = -effect(k++);
        if (model.has_axes) out.tilt_correction = -(effect(k) + effect(k + 1));
        out.corrected = out.row.acceleration - out.row.tide - MilliGal(fit.at(x));
        if (out.row.reference) out.residual = *out.row.reference - out.corrected;
        set_uncertainty(out, fit, s, x);
        if (out.residual)
            out.studentised_residual =
                studentised_residual(out.residual->value(), out.leverage.value(), out.is_used, fit);
    }
    const std::vector<std::string> names = coefficient_names(model);
    for (std::size_t k = 0; k < names.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        result.coefficients.push_back({names[k], fit.coefficients(at), std::nullopt});
        if (s) result.coefficients.back().standard_error = *s * std::sqrt(fit.cofactor(at, at));
    }
}

/// Returns the 95 % interval of the LOO, from the leave-one-out errors r / (1 - h), which are exact
/// for least squares.
std::optional<Interval> loo_interval(const SurveyCorrection& result) {
    std::vector<double> errors;
    std::vector<std::string> stations;
    for (const CorrectedRow& row : result.rows) {
        if (!row.is_used) continue;
        errors.push_back(row.residual->value() / (1.0 - row.leverage.value()));
        stations.push_back(row.row.site);
    }
    if (!result.score.loo_mgal) return std::nullopt;
    return bootstrap_rms_interval(errors, stations, result.options.seed);
}

void correct_robust(SurveyCorrection& result, const LinearModel& model, Applied& applied,
                    const std::vector<SurveyRow>& used, UtcTime origin) {
    const auto robust = fit_robust_model(model, used, origin, result.options.priors);
    if (!robust)
        throw InputError(
            fmt::format("model = robust: {} rows with a reference are too few for {}, or too many "
                        "of them are equal; allowed: more rows",
                        used.size(), model.name));
    applied.fit = robust->fit;
    applied.s_mgal = robust->s;
    correct_linear(result, model, applied);
    Eigen::Index at = 0;
    for (CorrectedRow& row : result.rows) {
        // The robust scale hardly depends on a single row, so it is used as it is.
        row.studentised_residual.reset();
        if (row.residual && row.leverage.value() < 1.0) {
            const double share =
                row.is_used ? 1.0 - row.leverage.value() : 1.0 + row.leverage.value();
            row.studentised_residual = row.residual->value() / (robust->s * std::sqrt(share));
        }
        if (row.is_used) row.weight = robust->weights(at++);
    }
}

void correct_as_published(SurveyCorrection& result, const std::vector<SurveyRow>& rows,
                          const std::vector<bool>& in_use, const Applied& line_fit) {
    const TemperatureLine line = fit_temperature_line(rows, in_use).value();
    const std::vector<double> corrected1 = temperature_corrected_mgal(rows, line);
    const DriftStep step = find_end_point_drift(rows, in_use, corrected1, result.options.base);
    if (!step.drift)
        throw InputError(
            fmt::format("model = paper: the drift step is refused, {}; allowed: another base, or a "
                        "model of auto, t, t-rate, t-drift, t-rate-drift",
                        step.refusal));
    const std::vector<double> corrected2 = drift_corrected_mgal(rows, corrected1, *step.drift);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        CorrectedRow& out = result.rows[i];
        out.corrected1 = MilliGal(corrected1[i]);
        out.corrected = MilliGal(corrected2[i]);
        out.temperature_correction = *out.corrected1 - (rows[i].acceleration - rows[i].tide);
        out.drift_correction = step.drift->at(rows[i].time);
        if (rows[i].reference) out.residual = *rows[i].reference - out.corrected;
        set_uncertainty(out, line_fit.fit, result.score.s_mgal,
                        line_fit.columns.row(static_cast<Eigen::Index>(i)).transpose());
    }
    std::optional<double> slope_error;
    if (const auto s = line_fit.fit.residual_scale())
        slope_error = *s * std::sqrt(line_fit.fit.cofactor(1, 1));
    result.coefficients = {
        {"temperature_mgal_per_degc", line.slope_mgal_per_degc, slope_error},
        {"intercept_at_0_degc_mgal", line.intercept.value(), std::nullopt},
        {"r_squared", line.r_squared, std::nullopt},
        {"first_base_error_mgal", step.drift->first_error.value(), std::nullopt},
        {"last_base_error_mgal", step.drift->last_error.value(), std::nullopt},
        {"drift_mgal_per_h", step.drift->rate_mgal_per_h(), std::nullopt},
    };
}

std::vector<StationValue> average_stations(const std::vector<CorrectedRow>& rows,
                                           const std::vector<bool>& not_flagged,
                                           const Applied& applied, std::optional<double> s_mgal) {
    std::vector<StationValue> stations;
    for (const CorrectedRow& first : rows) {
        const std::string& site = first.row.site;
        if (std::ranges::find(stations, site, &StationValue::site) != stations.end()) continue;
        StationValue station;
        station.site = site;
        station.reference = first.row.reference;
        station.is_flagged_only = true;
        for (std::size_t i = 0; i < rows.size(); ++i)
            if (rows[i].row.site == site && not_flagged[i]) station.is_flagged_only = false;
        double sum = 0.0;
        Eigen::VectorXd x = Eigen::VectorXd::Zero(applied.columns.cols());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (rows[i].row.site != site) continue;
            if (rows[i].is_used)
                station.redundancy =
                    station.redundancy.value_or(0.0) + 1.0 - rows[i].leverage.value();
            if (!station.is_flagged_only && !not_flagged[i]) continue;
            ++station.row_count;
            sum += rows[i].corrected.value();
            x += applied.columns.row(static_cast<Eigen::Index>(i)).transpose();
        }
        const auto n = static_cast<double>(station.row_count);
        station.gravity = MilliGal(sum / n);
        // u = s sqrt(1/n + h of the mean of its rows)
        if (s_mgal)
            station.u_gravity =
                MilliGal(*s_mgal * std::sqrt(1.0 / n + applied.fit.leverage_at(x / n)));
        if (station.reference) station.residual = *station.reference - station.gravity;
        stations.push_back(std::move(station));
    }
    return stations;
}

}  // namespace

std::vector<std::string> model_names() {
    std::vector<std::string> names{"auto", "paper", "day"};
    for (const LinearModel& model : kLinearModels) names.emplace_back(model.name);
    for (const LinearModel& model : kModelsOnRequest) names.emplace_back(model.name);
    names.insert(names.end(), {"network", "robust"});
    return names;
}

void add_left_out(SurveyCorrection& result, const std::vector<LeftOut>& occupations) {
    auto& all = result.left_out;
    all.insert(all.end(), occupations.begin(), occupations.end());
    std::ranges::stable_sort(all, {}, &LeftOut::start);
}

SurveyCorrection correct_survey(const std::vector<SurveyRow>& rows, const SurveyOptions& options,
                                const DayRecord* day) {
    const std::vector<std::string> names = model_names();
    if (std::ranges::find(names, options.model) == names.end())
        throw InputError(
            fmt::format("model = {}: unknown; allowed: {}", options.model, text::joined(names)));
    if (rows.empty()) throw InputError("no occupations; allowed: at least two with a reference");
    SurveyCorrection result;
    result.options = options;
    if (result.options.base.empty()) result.options.base = rows.front().site;
    require_row_of(rows, result.options.base, "base");
    for (const std::string& site : options.datum) require_row_of(rows, site, "datum");

    const UtcTime origin = rows.front().time;
    std::vector<bool> not_flagged, in_use, usable, unflagged_usable;
    for (const SurveyRow& row : rows) {
        usable.push_back(is_datum(row, options.datum));
        unflagged_usable.push_back(usable.back() && !row.is_flagged);
        not_flagged.push_back(!row.is_excluded && !(options.use_flags && row.is_flagged));
        in_use.push_back(usable.back() && not_flagged.back());
        CorrectedRow out;
        out.row = row;
        out.is_used = in_use.back();
        if (row.reference) out.difference = row.acceleration - *row.reference - row.tide;
        result.rows.push_back(std::move(out));
    }
    const std::string& base = result.options.base;
    const ModelPriors& priors = result.options.priors;
    result.row_sets = {
        score_all_models("used", rows, unflagged_usable, result.options),
        score_all_models("all", rows, usable, result.options),
    };

    if (options.model == "network") {
        correct_network(result, rows, not_flagged);
        set_doubts(result);
        return result;
    }

    const std::vector<SurveyRow> used = chosen_rows(rows, in_use);
    result.model = options.model;
    auto refusal = day_refusal(rows, in_use, day, helps_to_correct_day(options.calibration));
    if (!refusal &&
        std::ranges::any_of(priors.values, [](const auto& prior) { return prior.has_value(); }))
        refusal = "uses its own priors, `prior` would be ignored";
    if (options.model == "day" && refusal)
        throw InputError("model = day: " + *refusal + "; allowed: another model");
    if (options.model == "day" || (options.model == "auto" && !refusal)) {
        correct_by_day(result, {usable, unflagged_usable}, *day);
        set_doubts(result);
        return result;
    }
    if (options.model == "auto") {
        if (day != nullptr) result.remarks.push_back("not the whole-day model: " + *refusal);
        result.choice = choose_model(used, origin, base, priors);
        result.choice_loso_mgal = choice_loso_mgal(used, origin, base, priors);
        // With too few stations to compare models, the simplest one is taken, or its refusal.
        result.model = result.choice ? result.choice->model : "t";
    }
    const bool is_robust = result.model == "robust";
    const LinearModel* const model =
        find_linear_model(is_robust ? options.robust_terms : result.model);
    // The line of `paper` is the publication's: it has no priors.
    Applied applied = model != nullptr ? apply_model(*model, rows, used, origin, priors)
                                       : apply_model(kLinearModels.front(), rows, used, origin, {});
    const auto add_scores = [&](const auto& score_model) {
        const std::vector<bool>* const sets[] = {&unflagged_usable, &usable};
        for (std::size_t k = 0; k < 2; ++k)
            result.row_sets[k].scores.push_back(
                score_model(*model, chosen_rows(rows, *sets[k]), origin, priors));
    };
    if (is_robust) {
        add_scores(score_robust_model);
        result.score = result.row_sets[options.use_flags ? 0 : 1].scores.back();
        correct_robust(result, *model, applied, used, origin);
    } else if (model != nullptr) {
        if (std::ranges::find(kModelsOnRequest, model->name, &LinearModel::name) !=
            kModelsOnRequest.end())
            add_scores(score_linear_model);
        result.score = score_linear_model(*model, used, origin, priors);
        correct_linear(result, *model, applied);
        result.loo_interval_mgal = loo_interval(result);
    } else {
        result.score = score_paper_model(rows, in_use, base);
        correct_as_published(result, rows, in_use, applied);
    }
    result.stations = average_stations(result.rows, not_flagged, applied, result.score.s_mgal);
    set_doubts(result);
    return result;
}

}  // namespace a351::corrector
