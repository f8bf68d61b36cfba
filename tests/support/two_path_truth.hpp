#pragma once
/// @file
/// What a two-path fit should find in a simulated record.

#include <array>
#include <cstdint>

#include "corrector/long_record/two_path_fit.hpp"
#include "sim/scenario/scenario.hpp"

namespace a351::sim {

struct TwoPathTruth {
    /// In the order of TwoPathTerm, in the units of the fit; lags and time in seconds.
    std::array<double, corrector::kTwoPathTerms> values{};

    [[nodiscard]] double operator[](corrector::TwoPathTerm term) const {
        return values.at(static_cast<std::size_t>(term));
    }
    [[nodiscard]] double static_slope() const;  ///< rA + rS, mGal/degC.
};

/// Of the unit that the seed draws.  The warm-up is the one that the thermometer does not show, less what
/// the paths make of the thermometer's own: two exponentials, taken as one of their size and slope at the
/// record's begin.
[[nodiscard]] TwoPathTruth two_path_truth(const Scenario& scenario, std::uint64_t seed);

/// Estimate less truth in standard errors; of lags and time by logarithm.
[[nodiscard]] double deviation(const corrector::TwoPathFit& fit, const TwoPathTruth& truth,
                               corrector::TwoPathTerm term);
[[nodiscard]] double static_slope_deviation(const corrector::TwoPathFit& fit,
                                            const TwoPathTruth& truth);

}  // namespace a351::sim
