#pragma once
/// @file
/// Interior extrema of a sampled curve: changes of its direction.  A plateau between a rise and a
/// fall is one extremum; one that touches either end is none.  Maxima and minima alternate.

#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector {

/// Number of interior maxima and minima of `curve`.
[[nodiscard]] std::size_t count_extrema(std::span<const double> curve) noexcept;

/// Middles of the interior extrema of `curve`, rounded down, in ascending order.
[[nodiscard]] std::vector<std::size_t> extremum_indices(std::span<const double> curve);

}  // namespace a351::corrector
