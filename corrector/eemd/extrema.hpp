#pragma once
/// @file
/// Interior extrema of a sampled curve: changes of its direction.  A plateau between a rise and a
/// fall is one extremum.  A plateau that touches either end is no extremum.  Maxima and minima
/// alternate.

#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector {

/// Returns the number of interior maxima and minima of `curve`.
///
/// @param curve  (n), any n and unit; fewer than three samples have no extremum.  A NaN counts as
///               equal to its neighbours.
[[nodiscard]] std::size_t count_extrema(std::span<const double> curve) noexcept;

/// Returns the sample indices of the interior extrema of `curve`, in ascending order.  The index of
/// a plateau is its middle, rounded down.  NaN as in count_extrema().
[[nodiscard]] std::vector<std::size_t> extremum_indices(std::span<const double> curve);

}  // namespace a351::corrector
