#include <cmath>
#include <functional>

#include "corrector/model/applied_fit.hpp"
#include "corrector/model/model.hpp"

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

/// Means of the accepted rows of a station.
struct StationMean {
    StationValue* value;
    Eigen::VectorXd x;  ///< Regressors.
    MilliGal reading;   ///< acceleration - tide
    double count = 0.0;
};

std::vector<StationMean> means_of(Fit& result, const Eigen::MatrixXd& columns,
                                  const RowChoice& choice) {
    std::vector<StationMean> means;
    for (StationValue& station : result.stations) {
        if (station.is_flagged_only) continue;
        StationMean mean{&station, Eigen::VectorXd::Zero(columns.cols()), MilliGal(0.0)};
        const auto n = static_cast<double>(station.row_count);
        for (std::size_t i = 0; i < result.rows.size(); ++i) {
            const reading::SurveyRow& row = result.rows[i].row;
            if (row.site != station.site || !choice.accepted[i]) continue;
            mean.x += columns.row(static_cast<Eigen::Index>(i)).transpose() / n;
            mean.reading = mean.reading + MilliGal((row.acceleration - row.tide).value() / n);
            mean.count += 1.0;
        }
        means.push_back(std::move(mean));
    }
    return means;
}

/// Returns the fit without the rows of two stations, which may be the same.
std::optional<LinearFit> fit_without(const LinearModel& terms, const SurveyProblem& problem,
                                     const RowChoice& choice, const std::string& a,
                                     const std::string& b) {
    std::vector<reading::SurveyRow> rows = chosen_rows(problem.rows, choice.in_use);
    std::erase_if(rows,
                  [&](const reading::SurveyRow& row) { return row.site == a || row.site == b; });
    return fit_model(terms, rows, problem.origin(), problem.options.priors);
}

/// Returns the covariance V of the slopes b, mGal^2 over the units of two columns.
Eigen::MatrixXd slope_covariance(const LinearFit& fit, double s_mgal) {
    const Eigen::Index q = fit.column_means.size();
    return fit.covariance(s_mgal).bottomRightCorner(q, q);
}

StationCovariance covariance_of(const std::vector<StationMean>& means, const LinearFit& fit,
                                double s_mgal) {
    StationCovariance covariance;
    const auto count = std::ssize(means);
    const Eigen::MatrixXd slopes = slope_covariance(fit, s_mgal);
    covariance.mgal2.resize(count, count);
    for (Eigen::Index a = 0; a < count; ++a) {
        const StationMean& mean = means[static_cast<std::size_t>(a)];
        covariance.sites.push_back(mean.value->site);
        for (Eigen::Index b = 0; b < count; ++b) {
            const StationMean& other = means[static_cast<std::size_t>(b)];
            covariance.mgal2(a, b) =
                s_mgal * s_mgal *
                    ((a == b ? 1.0 / mean.count : 0.0) +
                     1.0 / static_cast<double>(fit.row_count())) +
                (mean.x - fit.column_means).dot(slopes * (other.x - fit.column_means));
        }
    }
    return covariance;
}

/// Sets left_out and u_left_out of the stations, all differences and the covariance.
///
/// A value is that of the fit to the rows of the other stations, a difference that of the fit
/// without both stations: d = mean(D)_to - mean(D)_from - (x_to - x_from)' b, with
/// u^2 = s^2 (1/n_from + 1/n_to) + (x_to - x_from)' V (x_to - x_from).  x are mean regressors, n
/// numbers of rows, s is that of the fit to all rows, and V is the covariance of the slopes b.  The
/// covariance is that of StationValue::gravity as if the stations were not in the fit.
///
/// A pair without which the rows do not determine the model is left out.  Cost: one fit for each
/// pair.
/// @param result   with corrected rows and stations.
/// @param columns  AppliedFit::columns.
void set_left_out_stations(Fit& result, const LinearModel& terms, const SurveyProblem& problem,
                           const RowChoice& choice, const Eigen::MatrixXd& columns) {
    const std::vector<StationMean> means = means_of(result, columns, choice);
    const auto all = fit_without(terms, problem, choice, "", "");
    if (!all || !all->residual_scale()) return;
    const double s_mgal = *all->residual_scale();
    for (std::size_t b = 0; b < means.size(); ++b) {
        const StationMean& to = means[b];
        if (const auto fit = fit_without(terms, problem, choice, to.value->site, "")) {
            to.value->left_out = to.reading - MilliGal(fit->at(to.x));
            to.value->u_left_out =
                MilliGal(std::sqrt(s_mgal * s_mgal / to.count + fit->variance_at(to.x, s_mgal)));
        }
        for (std::size_t a = 0; a < b; ++a) {
            const StationMean& from = means[a];
            const auto fit = fit_without(terms, problem, choice, from.value->site, to.value->site);
            if (!fit) continue;
            const Eigen::VectorXd step = to.x - from.x;
            result.differences.push_back(difference_of(
                *from.value, *to.value,
                to.reading - from.reading - MilliGal(fit->at(to.x) - fit->at(from.x)),
                MilliGal(std::sqrt(s_mgal * s_mgal * (1.0 / from.count + 1.0 / to.count) +
                                   step.dot(slope_covariance(*fit, s_mgal) * step)))));
        }
    }
    result.covariance = covariance_of(means, *all, s_mgal);
}

Score score(const LinearModel& given, const SurveyProblem& problem, const RowChoice& choice) {
    const Priors& priors = problem.options.priors;
    return score_linear_model(with_scale(given, priors), chosen_rows(problem.rows, choice.in_use),
                              problem.origin(), priors);
}

std::optional<Noise> noise(const LinearModel& given, const ChosenSurvey& survey,
                           const Noise* nearby) {
    return linear_noise(with_scale(given, survey.problem.options.priors), survey, nearby);
}

std::optional<residual::Residuals> residuals(const LinearModel& given, const ChosenSurvey& survey,
                                             const Noise& of_survey) {
    return linear_residuals(with_scale(given, survey.problem.options.priors), survey, of_survey);
}

FitResult fit(const LinearModel& given, const SurveyProblem& problem, const RowChoice& choice) {
    const Priors& priors = problem.options.priors;
    const LinearModel terms = with_scale(given, priors);
    auto applied = apply_model(terms, problem, choice, priors);
    if (auto* const refusal = std::get_if<Refusal>(&applied)) return std::move(*refusal);
    const auto& linear = std::get<AppliedFit>(applied);
    Fit result;
    result.rows = uncorrected(problem, choice);
    result.score = score(given, problem, choice);
    correct_rows(result, terms, linear, priors);
    result.own = LinearPart{loo_interval(result, problem.options.seed)};
    result.stations = average_stations(result, choice.accepted, linear, result.score.s_mgal);
    set_left_out_stations(result, terms, problem, choice, linear.columns);
    return result;
}

}  // namespace

std::vector<Model> linear_models() {
    std::vector<Model> list;
    const auto add = [&list](const LinearModel& terms, bool is_always_scored) {
        list.push_back({terms.name, is_always_scored, std::bind_front(fit, terms),
                        std::bind_front(score, terms), std::bind_front(noise, terms),
                        std::bind_front(residuals, terms)});
    };
    for (const LinearModel& terms : kLinearModels) add(terms, true);
    for (const LinearModel& terms : kModelsOnRequest) add(terms, false);
    return list;
}

}  // namespace a351::corrector::model
