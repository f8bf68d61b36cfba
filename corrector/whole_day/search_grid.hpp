#pragma once
/// @file
/// Grids for the points and the costs of a search by NLopt, which hide the last bits.
///
/// NLopt's own arithmetic differs in the last bits between processors (Debian compiles it with fused multiply-adds for arm64
/// and without for amd64), and so do the C library's functions.  A search that compares such numbers takes another way and
/// ends elsewhere within its tolerance of 1e-3 or 1e-2 deviations.  On these grids it takes the same way, except where a
/// number lies within rounding of the middle between two steps.

#include <cmath>

namespace a351::corrector {

/// Rounds a parameter, in deviations of its prior, to a multiple of 2^-14: a sixteenth of the smaller tolerance.
inline double search_point(double value) {
    constexpr double kSteps = 16384.0;
    return std::nearbyint(value * kSteps) / kSteps;
}

/// Rounds a negative log likelihood to a multiple of 2^-26.  Its curvature is at least that of the priors, 1: the step moves
/// the minimum by at most 1.7e-4 deviations, and is far above the rounding of the sum, about 1e-12.
inline double search_cost(double value) {
    constexpr double kSteps = 67108864.0;
    return std::nearbyint(value * kSteps) / kSteps;
}

}  // namespace a351::corrector
