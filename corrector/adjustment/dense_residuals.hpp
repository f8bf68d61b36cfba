#pragma once
/// @file
/// Residuals of a few hundred readings in dense form, with any covariance of their errors.
///
/// The readings are y = X b + Z c + errors.  Of the unknowns b nothing is known beforehand; for c
/// there are priors, and the errors have a covariance.  S is the covariance of Z c + errors, and W a
/// whitening, W S W' = 1.  If the model fits, W y without its part in the space of W X consists of
/// independent numbers of variance 1:
///
///     const Direction step = residuals.direction(after);   // effect of +1 mGal on each reading
///     const double t = step.unit.dot(residuals.values);    // normal, of variance 1
///     t / step.length;                                     // size of the step, mGal
///     1.0 / step.length;                                   // its standard uncertainty, mGal
///
/// The whole-day model makes them (set_up_residuals.hpp).

#include <Eigen/Core>
#include <memory>
#include <random>

#include "corrector/adjustment/residuals.hpp"

namespace a351::corrector::adjustment {

/// The effect of something on the residuals.
struct Direction {
    Eigen::VectorXd unit;     ///< (k) Of length 1; 0 if the unknown quantities explain the effect.
    Eigen::VectorXd scatter;  ///< (k) Its part in the scatter, see DenseResiduals::to_scatter.
    double length = 0.0;      ///< Length of the whitened effect before; 0 as `unit`.
};

/// Residuals of n readings.
struct DenseResiduals {
    Eigen::VectorXd values;     ///< (k) Whitened, without their part in the space of `unknown`.
    Eigen::MatrixXd whitening;  ///< (k, n) Whitened effect of +1 mGal in each reading.
    Eigen::MatrixXd unknown;    ///< (k, u) Orthonormal basis of the unknown quantities.
    /// (k, k) Turns residuals into the scatter of the readings about the most likely course, in
    /// standard deviations of the noise alone.  Variance that the priors expect and the readings
    /// do not need has no part in it, so that priors may be too wide.
    Eigen::MatrixXd to_scatter;

    /// Removes the part that the unknown quantities explain.
    void project(Eigen::VectorXd& whitened) const;

    /// Returns the direction of an effect.
    /// @param effect_mgal  (n) effect on each reading.
    [[nodiscard]] Direction direction(const Eigen::VectorXd& effect_mgal) const;

    /// Returns the whitened effect (k) minus the part of the unknown quantities.
    [[nodiscard]] Eigen::VectorXd projected(const Eigen::VectorXd& effect_mgal) const;

    /// Returns the expected square of the scatter: its degrees of freedom.
    [[nodiscard]] double dof() const;

    /// Returns residuals (k) as they would be if the model were true.
    [[nodiscard]] Eigen::VectorXd simulated(std::mt19937_64& generator) const;
};

/// Returns independent normal numbers of variance 1, the same for a seed on any machine.
[[nodiscard]] Eigen::VectorXd normal_vector(std::mt19937_64& generator, Eigen::Index size);

/// Returns an orthonormal basis of the columns' space (k, rank).
[[nodiscard]] Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& columns);

/// Returns what residuals say about effects (residuals.hpp).
[[nodiscard]] std::unique_ptr<Residuals> effects_on(DenseResiduals residuals);

}  // namespace a351::corrector::adjustment
