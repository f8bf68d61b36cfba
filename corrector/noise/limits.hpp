#pragma once

namespace a351::corrector::noise {

/// A value with its confidence limits: low <= value <= high.
struct Limits {
    double value = 0.0, low = 0.0, high = 0.0;
};

/// Returns the 95 % limits of a variance whose estimate has the distribution of chi-square.
/// @param dof  degrees of freedom, above 0.
[[nodiscard]] Limits variance_limits(double variance, double dof);

}  // namespace a351::corrector::noise
