#pragma once
/// @file
/// Sums over the members of an ensemble, with the same bits on any number of threads.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "corrector/eemd/emd.hpp"

namespace a351::corrector {

struct EnsemblePlan {
    std::span<const double> signal;  ///< (n), finite.
    double noise_level = 0.0;        ///< Std. deviation of the added noise, unit of the signal.
    int members = 1;                 ///< >= 1
    std::size_t mode_count = 0;      ///< Without the residue.
    StoppingRule stopping;
    FinishRule finish = FinishRule::at_most_two_extrema;
    std::uint64_t seed = 0;
    double residue_origin = 0.0;  ///< Subtracted from the residue before it is squared.
};

/// Sums over all members, one component after the other, the residue last: (n (mode_count + 1)).
struct EnsembleSums {
    std::vector<double> values;
    std::vector<double> squares;  ///< Of the modes, and of residue - residue_origin.
};

/// Members are summed in blocks of fixed size, each in member order, and the blocks in block order
/// whichever thread finishes first.
/// @throws std::bad_alloc, std::system_error  before any work is done, or after all of it.
[[nodiscard]] EnsembleSums sum_ensemble(const EnsemblePlan& plan, int threads);

}  // namespace a351::corrector
