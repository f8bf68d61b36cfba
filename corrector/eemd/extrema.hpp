#pragma once
/// @file
/// Interior extrema of a sampled curve: changes of its direction.  A plateau between a rise and a
/// fall is one extremum.  A plateau that touches either end is no extremum.  Maxima and minima
/// alternate.
///
/// The rule is that of the sifting (SiftKernels::find_extrema), so a count here is the number of
/// extrema that a sift finds.  Noise makes extrema: smooth a noisy curve before counting its waves.
///
/// Neighbours are compared exactly, without a tolerance: a difference in the last bit is a rise or
/// a fall.  The time is O(n).

#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector::eemd {

/// Returns the number of interior maxima and minima of `curve`.
///
/// @param curve  (n), any n and unit; fewer than three samples have no extremum.  A NaN counts as
///               equal to its neighbours.  The jump from one side of a NaN to the other is not
///               seen.  Infinite samples are compared like others.
[[nodiscard]] std::size_t count_extrema(std::span<const double> curve);

/// Returns the sample indices of the interior extrema of `curve`, in ascending order.  The index of
/// a plateau is its middle, rounded down.  NaN as in count_extrema().
///
/// Maxima and minima alternate in the result.  The first extremum is a maximum if the curve is
/// higher there than at its first sample.
/// @return  empty without extrema; 1 <= index <= n - 2 otherwise.
[[nodiscard]] std::vector<std::size_t> extremum_indices(std::span<const double> curve);

}  // namespace a351::corrector::eemd
