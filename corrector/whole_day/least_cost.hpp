#pragma once
/// @file
/// Search for the least cost by NLopt, on grids of points and costs, so that the last bits have no
/// effect on it.
///
/// NLopt's own arithmetic differs in the last bits between processors: Debian compiles it with
/// fused multiply-adds for arm64 and without for amd64.  The functions of the C library differ too.
/// A search that compares such numbers takes another path and ends elsewhere within its tolerance
/// of 1e-3 or 1e-2 deviations.  On these grids it takes the same path, except if a number is within
/// rounding of the middle between two steps.
///
/// Use it for a negative log likelihood plus priors, in which every parameter counts in standard
/// deviations of its prior.  A cost of another size does not suit the steps.
///
///     const auto u = least_cost_point(cost, {0.0, 0.0}, false,
///         {.farthest = 12.0, .first_step = 0.5, .tolerance = 1e-3, .most_costs = 2000});
///
/// All functions are pure; searches in several threads do not influence each other.

#include <cmath>
#include <functional>
#include <vector>

namespace a351::corrector::whole_day {

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

/// Limits of a search, in deviations of the priors.  All are > 0; not checked.
struct SearchLimits {
    double farthest;    ///< Bound of every parameter, on either side of 0.
    double first_step;  ///< Step with which the search begins.
    double tolerance;   ///< The search ends with changes below it; 1e-3 and 1e-2 suit the grid.
    int most_costs;     ///< Largest number of costs computed.
};

/// Returns the point of least cost on the grid of search_point().
///
/// Without a start nearby: Subplex, which no shape of the cost stops too early.  With one: BOBYQA,
/// which needs a third to a fifth of the time.
///
/// The search finds a local minimum.  If it ends early, by `most_costs` or an error of NLopt, the
/// best point so far is returned, and this is not reported.
/// @param cost       returns the cost of a point; HUGE_VAL if it overflows.  Called by one thread.
///                   It must not throw, because NLopt is written in C.
/// @param start      start of the search, within `limits.farthest` of 0; another one is returned
///                   without a search, on the grid.
/// @param is_nearby  true if the start is close to the minimum.
/// @param limits     see SearchLimits.
[[nodiscard]] std::vector<double> least_cost_point(
    const std::function<double(const std::vector<double>&)>& cost, std::vector<double> start,
    bool is_nearby, const SearchLimits& limits);

}  // namespace a351::corrector::whole_day
