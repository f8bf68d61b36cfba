#include "corrector/model/left_out_stations.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace a351::corrector::model {
namespace {

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

/// Returns (a' C b), C the cofactor of the slopes.
double product(const LinearFit& fit, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    const Eigen::Index p = a.size();
    return a.dot(fit.cofactor.bottomRightCorner(p, p) * b);
}

StationCovariance covariance_of(const std::vector<StationMean>& means, const LinearFit& fit,
                                double s_mgal) {
    StationCovariance covariance;
    const auto count = std::ssize(means);
    covariance.mgal2.resize(count, count);
    for (Eigen::Index a = 0; a < count; ++a) {
        const StationMean& mean = means[static_cast<std::size_t>(a)];
        covariance.sites.push_back(mean.value->site);
        for (Eigen::Index b = 0; b < count; ++b) {
            const StationMean& other = means[static_cast<std::size_t>(b)];
            covariance.mgal2(a, b) =
                s_mgal * s_mgal *
                ((a == b ? 1.0 / mean.count : 0.0) + 1.0 / static_cast<double>(fit.row_count()) +
                 product(fit, mean.x - fit.column_means, other.x - fit.column_means));
        }
    }
    return covariance;
}

}  // namespace

void set_left_out_stations(Fit& result, const LinearModel& terms, const SurveyProblem& problem,
                           const RowChoice& choice) {
    const std::vector<StationMean> means =
        means_of(result, model_columns(terms, problem.rows, problem.origin()), choice);
    const auto all = fit_without(terms, problem, choice, "", "");
    if (!all || !all->residual_scale()) return;
    const auto dof = static_cast<double>(all->dof());
    for (StationValue& station : result.stations) {
        station.dof = dof;
        station.coverage_factor = boost::math::quantile(boost::math::students_t(dof), 0.975);
    }
    for (std::size_t b = 0; b < means.size(); ++b) {
        const StationMean& to = means[b];
        if (const auto fit = fit_without(terms, problem, choice, to.value->site, "");
            fit && fit->residual_scale()) {
            to.value->left_out = to.reading - MilliGal(fit->at(to.x));
            to.value->u_left_out = MilliGal(*fit->residual_scale() *
                                            std::sqrt(1.0 / to.count + fit->leverage_at(to.x)));
        }
        for (std::size_t a = 0; a < b; ++a) {
            const StationMean& from = means[a];
            const auto fit = fit_without(terms, problem, choice, from.value->site, to.value->site);
            if (!fit || !fit->residual_scale()) continue;
            const Eigen::VectorXd step = to.x - from.x;
            StationDifference difference{
                from.value->site, to.value->site,
                to.reading - from.reading - MilliGal(fit->at(to.x) - fit->at(from.x)),
                MilliGal(*fit->residual_scale() *
                         std::sqrt(1.0 / from.count + 1.0 / to.count + product(*fit, step, step))),
                std::nullopt};
            if (from.value->reference && to.value->reference)
                difference.reference = *to.value->reference - *from.value->reference;
            result.differences.push_back(std::move(difference));
        }
    }
    result.covariance = covariance_of(means, *all, *all->residual_scale());
}

}  // namespace a351::corrector::model
