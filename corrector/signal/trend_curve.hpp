#pragma once
/// @file
/// The slow part of a series, as the sum of components of its decomposition.

#include <vector>

#include "corrector/eemd/eemd.hpp"

namespace a351::corrector {

/// Where the trend of an occupation comes from; the other one is computed beside it.
enum class TrendMethod {
    eemd,      ///< trend_curve() of the decomposition.
    smoother,  ///< smooth(), smoother.hpp.
};

/// Which components make the trend curve.  None is ever chosen by its number.
enum class TrendCurve {
    paper,  ///< The residue and the mode of the longest mean period.
    slow,   ///< The residue and every mode with at most 7 extrema: does not hang on one mode.
};

/// Sum of the chosen components, (n) in their unit.
[[nodiscard]] std::vector<double> trend_curve(const EemdResult& components, TrendCurve choice);

}  // namespace a351::corrector
