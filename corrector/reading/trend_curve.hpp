#pragma once
/// @file
/// The slow part of a series by its decomposition.

#include <span>
#include <vector>

#include "corrector/eemd/eemd.hpp"

namespace a351::corrector {

/// Where the trend of an occupation comes from; the other one is computed beside it.
enum class TrendMethod {
    eemd,      ///< trend_curve() of the decomposition.
    smoother,  ///< smooth(), smoother.hpp.
};

/// How much of the decomposition makes the trend curve.  No mode is ever chosen by its number.
enum class TrendCurve {
    paper,  ///< The residue and the mode of the longest mean period.
    slow,   ///< The residue after the fewest modes that leave at most 7 extrema in it.
};

/// The residue and the slowest mode that is not zero, (n) in their unit.
[[nodiscard]] std::vector<double> paper_curve(const EemdResult& components);

struct Trend {
    std::vector<double> curve;  ///< (n), unit of the signal.
    double noise_level = 0.0;   ///< Std. deviation of the added noise, unit of the signal.
};

/// @throws  as eemd().
[[nodiscard]] Trend trend_curve(std::span<const double> signal, const EemdOptions& decomposition,
                                TrendCurve choice);

}  // namespace a351::corrector
