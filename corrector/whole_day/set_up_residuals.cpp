#include "corrector/whole_day/set_up_residuals.hpp"

#include "corrector/whole_day/day_regression.hpp"
#include "protocol/linear_algebra/cholesky.hpp"

namespace a351::corrector::whole_day {

using Index = Eigen::Index;

Eigen::MatrixXd averaging(const reading::DayRecord& record, std::size_t set_ups) {
    Eigen::MatrixXd mean =
        Eigen::MatrixXd::Zero(static_cast<Index>(set_ups), std::ssize(record.bins));
    for (std::size_t i = 0; i < record.bins.size(); ++i)
        mean(static_cast<Index>(record.bins[i].set_up), static_cast<Index>(i)) =
            static_cast<double>(record.bins[i].times.size());
    return mean.array().colwise() / mean.rowwise().sum().array();
}

adjustment::DenseResiduals set_up_residuals(const DaySurvey& survey, const DayFit& fit,
                                            const NoiseCovariance& covariance_of_bins) {
    const DayRegression problem(survey);
    const reading::DayRecord& record = *survey.record;
    const Eigen::MatrixXd mean = averaging(record, survey.stations.size());
    const Eigen::MatrixXd scaled = mean * problem.scaled(fit.expected);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(problem.estimated());
    for (std::size_t k = 0; k < kDayTerms; ++k)
        values(static_cast<Index>(k)) = fit.coefficients.at(k).value;
    for (std::size_t k = 0; k < fit.on_scale.size(); ++k)
        values(problem.on_scale_begin() + static_cast<Index>(k)) = fit.on_scale[k].value;
    const Eigen::MatrixXd lags = mean * problem.lag_columns(fit.expected, values);
    const Eigen::MatrixXd noise =
        mean * covariance_of_bins.at(fit.expected_noise) * mean.transpose();
    Eigen::MatrixXd covariance = noise + lags * lags.transpose();
    std::vector<Index> unknown;
    for (Index k = 0; k < problem.estimated(); ++k) {
        if (problem.is_free(k))
            unknown.push_back(k + 1);
        else
            covariance += scaled.col(k + 1) * scaled.col(k + 1).transpose();
    }
    const linear_algebra::Cholesky factor(std::move(covariance));
    adjustment::DenseResiduals residuals;
    residuals.whitening.resize(mean.rows(), mean.rows());
    for (Index k = 0; k < mean.rows(); ++k)
        residuals.whitening.col(k) = factor.half_solve(Eigen::VectorXd::Unit(mean.rows(), k));
    // Readings minus their most likely course are V S^-1 y; V is the covariance of the noise alone, S
    // that with the priors.
    residuals.to_scatter =
        linear_algebra::Cholesky(noise).lower().transpose() * residuals.whitening.transpose();
    residuals.unknown =
        adjustment::orthonormal_basis(residuals.whitening * scaled(Eigen::all, unknown));
    residuals.values = residuals.whitening * scaled.col(0);
    residuals.project(residuals.values);
    // The columns have the sign of the face; effects on the readings have not.
    const std::vector<double> faces =
        reading::faces_of(record.bins, static_cast<std::size_t>(mean.rows()));
    residuals.whitening *=
        Eigen::Map<const Eigen::VectorXd>(faces.data(), mean.rows()).asDiagonal();
    return residuals;
}

}  // namespace a351::corrector::whole_day
