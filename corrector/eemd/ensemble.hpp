#pragma once
/// @file
/// Sums over the members of an ensemble, with the same bits on any number of threads.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "corrector/eemd/emd.hpp"

namespace a351::corrector {

struct EnsemblePlan {
    std::span<const double> signal;  ///< (margin + n + margin), finite.
    std::size_t margin = 0;          ///< Samples at either end that are decomposed but not summed.
    double noise_level = 0.0;        ///< Std. deviation of the added noise, unit of the signal.
    int members = 1;                 ///< >= 1; even with pairs.
    bool pairs = false;              ///< Members 2 j and 2 j + 1 get the same noise, negated once.
    std::size_t mode_count = 0;      ///< Without the residue.
    SiftOptions sifting;
    std::uint64_t seed = 0;
    double residue_origin = 0.0;  ///< Subtracted from the residue before it is squared.
    /// Room for all members, one after the other, or none.  With room, what is left of every member
    /// is put there, and that alone is summed, not the modes.
    std::span<double> left;
    bool continues = false;  ///< Members begin with the content of `left`, not with noise.
    const SiftKernels* kernels = &fastest_kernels();
};

/// Sums over all members, one component after the other, the residue last.
struct EnsembleSums {
    std::vector<double> values;  ///< (n components)
    /// (components) sums over draws and samples of the square of a draw's sum; a draw is a
    /// member, or a pair of them.  The residue counts from residue_origin.
    std::vector<double> squares;
};

/// Members are summed in blocks of fixed size, each in member order, and the blocks in block order
/// whichever thread finishes first.
///
/// @param progress  called in the caller's thread with the members summed so far, in steps of any
///                  size; false ends the work early.
/// @return the sums; nothing when progress() said so.
/// @throws std::bad_alloc, std::system_error  and whatever progress() throws.
[[nodiscard]] std::optional<EnsembleSums> sum_ensemble(const EnsemblePlan& plan, int threads,
                                                       const std::function<bool(int)>& progress);

}  // namespace a351::corrector
