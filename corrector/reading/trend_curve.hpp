#pragma once
/// @file
/// The slow part of a series, from its decomposition.
///
/// The mean of an occupation is that of its trend, whose extrema also choose the interval
/// (choose_interval()).  Use smooth() instead if the slowest period to keep is known.

#include <span>
#include <vector>

#include "corrector/eemd/eemd.hpp"

namespace a351::corrector::reading {

/// Method of an occupation's trend; the other one is computed too, for comparison.
enum class TrendMethod {
    eemd,      ///< trend_curve() of the decomposition; no period is chosen.
    smoother,  ///< smooth(), smoother.hpp; a cut-off period is chosen, and it has standard errors.
};

/// Part of the decomposition that is the trend curve.  No mode is chosen by its number.
enum class TrendCurve {
    paper,  ///< The residue and the mode of the longest mean period; to repeat the publication.
    slow,   ///< The residue after the smallest number of modes that leaves at most 7 extrema.
};

/// Returns the sum of the residue and the mode of the longest mean period among those that are not
/// zero; the residue if there is none.
///
/// A mode without extrema counts as infinitely slow.  Among modes of equal period the last one is
/// taken.  A mode is zero only if all its values are exactly 0.
/// @param components  from eemd(); all modes have the length of the residue, which is not checked.
/// @return (n), unit of the components.
[[nodiscard]] std::vector<double> paper_curve(const eemd::Result& components);

/// Returns the trend curve of a series.
///
/// With `slow` it is eemd_trend() with at most seven extrema.  The interval needs four of them, two
/// from either end.  With `paper` it is paper_curve() of eemd().
///
/// The same options give the same bits on any number of threads.  `slow` is faster, because slower
/// modes are never computed.
///
/// Accuracy (tests/unit/reading/trend_curve_test.cpp), on 16 simulated records of 450 samples with
/// a drift, a wave and white noise of half its amplitude: the rms error is 0.091 of the amplitude
/// with `slow` and 0.125 with `paper` (decimation.md).
/// @param signal         (n) as of eemd(): finite, without gaps.
/// @param decomposition  options of eemd(); an occupation uses EndRule::mirror with `slow`.
/// @param choice         see TrendCurve.
/// @return (n), unit of the signal.
/// @throws               as eemd().
[[nodiscard]] std::vector<double> trend_curve(std::span<const double> signal,
                                              const eemd::Options& decomposition,
                                              TrendCurve choice);

}  // namespace a351::corrector::reading
