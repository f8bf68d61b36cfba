#include "corrector/residual/residuals.hpp"

#include <Eigen/QR>
#include <cmath>
#include <numbers>

namespace a351::corrector::residual {
namespace {

using Index = Eigen::Index;

/// Least length of an effect that is left, relative to the whole effect.  Reason: below it the
/// uncertainty of its size is 1000 times that of the readings: nothing can be said about it.
constexpr double kLeastLeft = 1e-3;

}  // namespace

Eigen::VectorXd normal_vector(std::mt19937_64& generator, Index size) {
    // Box and Muller
    const auto uniform = [&generator] {  // in (0, 1]
        return (static_cast<double>(generator() >> 11) + 1.0) * 0x1p-53;
    };
    Eigen::VectorXd values(size);
    for (double& value : values) {
        const double radius = std::sqrt(-2.0 * std::log(uniform()));
        value = radius * std::cos(2.0 * std::numbers::pi * uniform());
    }
    return values;
}

void Residuals::project(Eigen::VectorXd& whitened) const {
    whitened -= unknown * (unknown.transpose() * whitened);
}

Eigen::VectorXd Residuals::projected(const Eigen::VectorXd& effect_mgal) const {
    Eigen::VectorXd whitened = whitening * effect_mgal;
    const double length = whitened.norm();
    project(whitened);
    if (whitened.norm() < kLeastLeft * length) whitened.setZero();
    return whitened;
}

Direction Residuals::direction(const Eigen::VectorXd& effect_mgal) const {
    Eigen::VectorXd unit = projected(effect_mgal);
    const double length = unit.norm();
    if (length > 0.0) unit /= length;
    Eigen::VectorXd scatter = to_scatter * unit;
    return {std::move(unit), std::move(scatter), length};
}

double Residuals::dof() const {
    return (to_scatter - to_scatter * unknown * unknown.transpose()).squaredNorm();
}

Eigen::VectorXd Residuals::simulated(std::mt19937_64& generator) const {
    Eigen::VectorXd drawn = normal_vector(generator, values.size());
    project(drawn);
    return drawn;
}

Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& columns) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
    return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), qr.rank());
}

Residuals residuals_of(const Eigen::MatrixXd& a, const Eigen::VectorXd& y,
                       const std::vector<std::size_t>& readings, const Eigen::VectorXd& weights,
                       std::size_t n) {
    Residuals residuals;
    residuals.unknown = orthonormal_basis(a);
    residuals.values = y;
    residuals.project(residuals.values);
    residuals.whitening = Eigen::MatrixXd::Zero(a.rows(), static_cast<Index>(n));
    for (std::size_t row = 0; row < readings.size(); ++row)
        if (readings[row] < n)
            residuals.whitening(static_cast<Index>(row), static_cast<Index>(readings[row])) =
                weights(static_cast<Index>(row));
    residuals.to_scatter = Eigen::MatrixXd::Identity(a.rows(), a.rows());
    return residuals;
}

}  // namespace a351::corrector::residual
