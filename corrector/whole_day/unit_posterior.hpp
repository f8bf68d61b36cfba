#pragma once
/// @file
/// Findings of a day about its unit, for another day of the same unit.
///
///     const UnitPosterior unit = unit_posterior(fit, priors);
///     const DayPriors next = unit.priors();     // of a later day

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "corrector/whole_day/day_fit.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector::whole_day {

/// Names of response and axis biases, in the order of GravityEstimate::shared_mgal.
inline constexpr std::array<std::string_view, kSharedErrors - 1> kUnitNames{
    unit::kThermalNames[static_cast<std::size_t>(unit::ThermalTerm::fast_lag)],
    unit::kThermalNames[static_cast<std::size_t>(unit::ThermalTerm::slow_lag)],
    unit::kThermalNames[static_cast<std::size_t>(unit::ThermalTerm::level)],
    unit::kThermalNames[static_cast<std::size_t>(unit::ThermalTerm::slow)],
    unit::kThermalNames[static_cast<std::size_t>(unit::ThermalTerm::fast)],
    unit::kAxisBiasNames[0],
    unit::kAxisBiasNames[1]};

/// Response and axis biases of a unit with their joint covariance, and its noise.
struct UnitPosterior {
    using Vector = Eigen::Matrix<double, static_cast<int>(kUnitNames.size()), 1>;
    using Matrix = Eigen::Matrix<double, Vector::SizeAtCompileTime, Vector::SizeAtCompileTime>;

    Vector values = Vector::Zero();          ///< In the order and units of kUnitNames.
    Matrix covariance = Matrix::Identity();  ///< Positive definite.
    DayNoise noise;                          ///< Roots of the expected variances.

    /// Returns the usual priors with these parameters instead of those of another unit; the axis
    /// biases have a known size.
    [[nodiscard]] DayPriors priors() const;
};

/// Returns the posterior of a day's unit.
/// @param fit, priors  the priors are those of the fit.
[[nodiscard]] UnitPosterior unit_posterior(const DayFit& fit, const DayPriors& priors);

}  // namespace a351::corrector::whole_day
