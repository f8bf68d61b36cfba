#include "corrector/model/linear_fit.hpp"

#include <cmath>
#include <limits>

#include "protocol/linear_algebra/pivoted_qr.hpp"

namespace a351::corrector::model {
namespace {

/// Returns the covariance (p, p) of all coefficients from that of the slopes, with the constant
/// b0 = mean(y) - mean(x) . b of a mean(y) without error.
Eigen::MatrixXd with_constant(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& column_means) {
    const Eigen::Index q = column_means.size();
    const Eigen::VectorXd with_mean = slopes * column_means;
    Eigen::MatrixXd all(q + 1, q + 1);
    all(0, 0) = column_means.dot(with_mean);
    all.block(1, 0, q, 1) = -with_mean;
    all.block(0, 1, 1, q) = -with_mean.transpose();
    all.bottomRightCorner(q, q) = slopes;
    return all;
}

}  // namespace

double LinearFit::at(const Eigen::Ref<const Eigen::VectorXd>& x) const {
    // Centred, because the constant b0 contains the rounding of large x.
    return mean + (x - column_means).dot(coefficients.tail(coefficients.size() - 1));
}

double LinearFit::leverage_at(const Eigen::Ref<const Eigen::VectorXd>& x) const {
    const Eigen::Index q = column_means.size();
    const Eigen::VectorXd centred = x - column_means;
    // 1/n + (x - mean)^T C (x - mean)
    return 1.0 / static_cast<double>(row_count()) +
           centred.dot(cofactor.bottomRightCorner(q, q) * centred);
}

Eigen::MatrixXd LinearFit::covariance(double s) const {
    // s^2 C (Xc^T Xc) C + row_sd^2 C W^2 C, with Xc^T Xc = C^-1 - W^2
    return s * s * cofactor + (row_sd * row_sd - s * s) * prior_cofactor;
}

double LinearFit::variance_at(const Eigen::Ref<const Eigen::VectorXd>& x, double s) const {
    const Eigen::Index q = column_means.size();
    const Eigen::VectorXd centred = x - column_means;
    return s * s * leverage_at(x) +
           (row_sd * row_sd - s * s) *
               centred.dot(prior_cofactor.bottomRightCorner(q, q) * centred);
}

std::optional<double> LinearFit::residual_scale() const {
    if (dof() <= 0) return std::nullopt;
    // s^2 = (RSS + RSS of the priors) / (n + priors - p)
    return std::sqrt((rss + prior_rss) / static_cast<double>(dof()));
}

std::optional<LinearFit> fit_linear(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                                    const Eigen::Ref<const Eigen::VectorXd>& y,
                                    const SlopePriors& priors) {
    const Eigen::Index n = columns.rows();
    const Eigen::Index q = columns.cols();
    LinearFit fit;
    fit.prior_count = (priors.weights.array() > 0.0).count();
    if (n < 1 || n + fit.prior_count < q + 1) return std::nullopt;

    fit.column_means = columns.colwise().mean().transpose();
    fit.mean = y.mean();
    const Eigen::MatrixXd x = columns.rowwise() - fit.column_means.transpose();
    const Eigen::VectorXd centred_y = y.array() - fit.mean;

    fit.coefficients.resize(q + 1);
    Eigen::VectorXd slopes = Eigen::VectorXd::Zero(q);
    Eigen::MatrixXd slope_cofactor = Eigen::MatrixXd::Zero(q, q);
    if (q > 0) {
        // The priors' rows are appended to the centred ones: the constant has no prior.
        Eigen::MatrixXd rows(n + fit.prior_count, q);
        Eigen::VectorXd right(n + fit.prior_count);
        rows.topRows(n) = x;
        right.head(n) = centred_y;
        for (Eigen::Index k = 0, row = n; k < q && row < rows.rows(); ++k) {
            if (!(priors.weights(k) > 0.0)) continue;
            rows.row(row) = priors.weights(k) * Eigen::RowVectorXd::Unit(q, k);
            right(row++) = priors.weights(k) * priors.values(k);
        }
        const linear_algebra::PivotedQr qr(rows);
        // Centring is exact to about 1e-16 of the values; the rest of a constant column is noise.
        const double noise =
            1e-12 * (1.0 + columns.cwiseAbs().maxCoeff()) * std::sqrt(static_cast<double>(n));
        if (!(qr.pivots().array() > noise).all() || qr.rank() < q) return std::nullopt;
        slopes = qr.solve(right);
        fit.prior_rss = (right - rows * slopes).tail(fit.prior_count).squaredNorm();
        // C = (Xc^T Xc + W^2)^-1
        const Eigen::MatrixXd root = qr.cofactor_root();
        slope_cofactor = root * root.transpose();
    }
    fit.coefficients(0) = fit.mean - slopes.dot(fit.column_means);
    fit.coefficients.tail(q) = slopes;
    fit.cofactor = with_constant(slope_cofactor, fit.column_means);
    fit.cofactor(0, 0) += 1.0 / static_cast<double>(n);
    if (fit.prior_count > 0) {
        const Eigen::MatrixXd weighted = priors.weights.asDiagonal() * slope_cofactor;
        fit.prior_cofactor = with_constant(weighted.transpose() * weighted, fit.column_means);
    } else {
        fit.prior_cofactor = Eigen::MatrixXd::Zero(q + 1, q + 1);
    }
    fit.row_sd = priors.row_sd;

    fit.residuals = centred_y - x * slopes;
    fit.rss = fit.residuals.squaredNorm();
    const double total = centred_y.squaredNorm();
    fit.r_squared = total > 0.0 ? 1.0 - fit.rss / total : std::numeric_limits<double>::quiet_NaN();
    fit.leverages.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) fit.leverages(i) = fit.leverage_at(columns.row(i));
    return fit;
}

}  // namespace a351::corrector::model
