#pragma once
/// @file
/// The slow part of a series, from its decomposition.

#include <span>
#include <vector>

#include "corrector/eemd/eemd.hpp"

namespace a351::corrector {

/// Method of an occupation's trend; the other one is computed too, for comparison.
enum class TrendMethod {
    eemd,      ///< trend_curve() of the decomposition.
    smoother,  ///< smooth(), smoother.hpp.
};

/// Part of the decomposition that is the trend curve.  No mode is chosen by its number.
enum class TrendCurve {
    paper,  ///< The residue and the mode of the longest mean period.
    slow,   ///< The residue after the smallest number of modes that leaves at most 7 extrema.
};

/// Returns the sum of the residue and the mode of the longest mean period among those that are not
/// zero; the residue if there is none.
/// @return (n), unit of the components.
[[nodiscard]] std::vector<double> paper_curve(const EemdResult& components);

/// Returns the trend curve of a series.
///
/// Accuracy (tests/unit/reading/trend_curve_test.cpp), on 16 simulated records of 450 samples with
/// a drift, a wave and white noise of half its amplitude: the rms error is 0.091 of the amplitude
/// with `slow` and 0.125 with `paper` (decimation.md).
/// @param signal         (n) as of eemd(): finite, without gaps.
/// @param decomposition  options of eemd().
/// @return (n), unit of the signal.
/// @throws               as eemd().
[[nodiscard]] std::vector<double> trend_curve(std::span<const double> signal,
                                              const EemdOptions& decomposition, TrendCurve choice);

}  // namespace a351::corrector
