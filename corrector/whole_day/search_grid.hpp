#pragma once
/// @file
/// Grids for the points and costs of an NLopt search, so that the last bits have no effect on it.
///
/// NLopt's own arithmetic differs in the last bits between processors: Debian compiles it with
/// fused multiply-adds for arm64 and without for amd64.  The functions of the C library differ too.
/// A search that compares such numbers takes another path and ends elsewhere within its tolerance
/// of 1e-3 or 1e-2 deviations.  On these grids it takes the same path, except if a number is within
/// rounding of the middle between two steps.

#include <cmath>

namespace a351::corrector {

/// Rounds a parameter, in deviations of its prior, to a multiple of 2^-14.  This is a sixteenth of
/// the smaller tolerance (same_sums_test.cpp).
inline double search_point(double value) {
    constexpr double kSteps = 16384.0;
    return std::nearbyint(value * kSteps) / kSteps;
}

/// Rounds a negative log likelihood to a multiple of 2^-26 (same_sums_test.cpp).  Its curvature is
/// at least that of the priors, 1, so that the step moves the minimum by at most 1.7e-4 deviations.
/// The step is far above the rounding of the sum, about 1e-12.
inline double search_cost(double value) {
    constexpr double kSteps = 67108864.0;
    return std::nearbyint(value * kSteps) / kSteps;
}

}  // namespace a351::corrector
