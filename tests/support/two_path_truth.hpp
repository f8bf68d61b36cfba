#pragma once
/// @file
/// True parameters that a two-path fit should find in a simulated record.

#include <array>
#include <cstdint>

#include "corrector/long_record/two_path_fit.hpp"
#include "sim/scenario/scenario.hpp"

namespace a351::sim {

struct TwoPathTruth {
    /// True values in the order of TwoPathTerm, in the units of the fit; lags and time in s.
    std::array<double, corrector::long_record::kTwoPathTerms> values{};

    [[nodiscard]] double operator[](corrector::long_record::TwoPathTerm term) const {
        return values.at(static_cast<std::size_t>(term));
    }
    [[nodiscard]] double static_slope() const;  ///< Level + slow path (rA + rS), mGal/degC.
};

/// Returns the truth for the unit drawn by the seed.  The warm-up is the part that the thermometer
/// does not show, minus the response of the paths to the warm-up of the thermometer.  These two
/// exponentials are replaced by one with their size and slope at the begin of the record.
[[nodiscard]] TwoPathTruth two_path_truth(const scenario::Scenario& scenario, std::uint64_t seed);

/// Returns estimate minus truth in standard errors; for lags and time by the logarithm of their
/// ratio.
[[nodiscard]] double deviation(const corrector::long_record::TwoPathFit& fit,
                               const TwoPathTruth& truth, corrector::long_record::TwoPathTerm term);
[[nodiscard]] double static_slope_deviation(const corrector::long_record::TwoPathFit& fit,
                                            const TwoPathTruth& truth);

}  // namespace a351::sim
