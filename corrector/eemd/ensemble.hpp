#pragma once
/// @file
/// Sums over the members of an ensemble; the bits do not depend on the number of threads.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "corrector/eemd/emd.hpp"

namespace a351::corrector {

/// A decomposition of all members, and what to sum.
struct EnsemblePlan {
    std::span<const double> signal;  ///< (margin + n + margin), finite.
    std::size_t margin = 0;          ///< Samples at either end, decomposed but not summed.
    double noise_level = 0.0;        ///< Std. deviation of the added noise, unit of the signal.
    int members = 1;                 ///< >= 1; even with pairs.
    bool pairs = false;              ///< Members 2 j and 2 j + 1 get the same noise, once negated.
    std::size_t mode_count = 0;      ///< Number of modes without the residue.
    SiftOptions sifting;
    std::uint64_t seed = 0;
    double residue_origin = 0.0;  ///< Subtracted from the residue before it is squared.
    /// Room for the rest of all members, one after the other (members x signal.size()), or empty.
    /// With room, the rest of every member is stored there, and only the rests are summed, not the
    /// modes.
    std::span<double> left;
    /// Members begin with the content of `left`, not with signal and noise.
    bool continues = false;
    const SiftKernels* kernels = &fastest_kernels();
};

/// Sums over all members for every component; the residue is the last component.
struct EnsembleSums {
    std::vector<double> values;  ///< (components x n), n samples of each component in turn.
    /// (components) sums over draws and samples of the square of a draw.  A draw is a member, or
    /// the sum of a pair.  The residue is taken relative to residue_origin per member.
    std::vector<double> squares;
};

/// Decomposes all members and sums their components.
///
/// Members are summed in blocks of fixed size, each in member order.  The blocks are added in block
/// order, whichever thread finishes first.
///
/// @param threads   number of threads, >= 1; more than the number of blocks are not used.
/// @param progress  may be empty; called in the caller's thread with the members summed so far, in
///                  steps of any size; false ends the work early.
/// @return the sums; nothing if progress() returned false.
/// @throws std::bad_alloc, std::system_error  if memory or threads are not available.
/// @throws  the exceptions of progress().
[[nodiscard]] std::optional<EnsembleSums> sum_ensemble(const EnsemblePlan& plan, int threads,
                                                       const std::function<bool(int)>& progress);

}  // namespace a351::corrector
