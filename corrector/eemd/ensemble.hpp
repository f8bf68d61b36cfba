#pragma once
/// @file
/// Sums over the members of an ensemble; the bits do not depend on the number of threads.
///
/// This is a part of eemd() and eemd_trend(), which scale the signal, check the options and make
/// means of the sums.  The functions here check nothing.
///
/// There are two ways to use it.  With an empty `left`, one call decomposes every member
/// completely.  With room in `left`, the members are kept between calls, and each call removes
/// further modes:
///
///     plan.left = room;       // members x signal.size()
///     plan.mode_count = 0;
///     sum_ensemble(plan, threads, {});    // sum of the members: signal and noise
///     plan.continues = true;
///     plan.mode_count = 1;
///     sum_ensemble(plan, threads, {});    // sum of the rest after one mode

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "corrector/eemd/emd.hpp"

namespace a351::corrector::eemd {

/// A decomposition of all members, and what to sum.
///
/// The spans refer to memory of the caller, which must exist during sum_ensemble().  A
/// default-constructed plan is one member of an empty signal without noise.
struct EnsemblePlan {
    std::span<const double> signal;  ///< (margin + n + margin), finite.
    std::size_t margin = 0;          ///< Samples at either end, decomposed but not summed.
    double noise_level = 0.0;        ///< Std. deviation of the added noise, unit of the signal.
    int members = 1;                 ///< >= 1; even with pairs.
    bool pairs = false;              ///< Members 2 j and 2 j + 1 get the same noise, once negated.
    std::size_t mode_count = 0;      ///< Number of modes without the residue.
    /// Stopping rule, finish rule and ends, the same for every member.
    SiftOptions sifting;
    /// Key of the noise.  Member m has noise m of fill_white_noise(), with pairs noise m / 2
    /// rounded down.
    std::uint64_t seed = 0;
    double residue_origin = 0.0;  ///< Subtracted from the residue before it is squared.
    /// Room for the rest of all members, one after the other (members x signal.size()), or empty.
    /// With room, the rest of every member is stored there, and only the rests are summed, not the
    /// modes.
    std::span<double> left;
    /// Members begin with the content of `left`, not with signal and noise.
    bool continues = false;
    /// Loops of one instruction set, not null; every set gives the same bits.
    const SiftKernels* kernels = &fastest_kernels();
};

/// Sums over all members for every component; the residue is the last component.
///
/// There are mode_count + 1 components, or one, the rest, if the plan has room in `left`.  A mode
/// that a member does not have counts as zeros.  Divide `values` by the number of members for the
/// mean.
struct EnsembleSums {
    std::vector<double> values;  ///< (components x n), n samples of each component in turn.
    /// (components) sums over draws and samples of the square of a draw.  A draw is a member, or
    /// the sum of a pair.  The residue is taken relative to residue_origin per member.
    /// With room in `left`, residue_origin is used only if mode_count is 0; otherwise squares are
    /// about 0.
    std::vector<double> squares;
};

/// Decomposes all members and sums their components.
///
/// Members are summed in blocks of fixed size, each in member order.  The blocks are added in block
/// order, whichever thread finishes first.
///
/// Each thread has its own workspace and sums, made before the first block.  That is about 13 +
/// mode_count doubles per sample, and mode_count + 1 more with pairs.
///
/// The time is proportional to members x modes x sifts x samples.  Calls from several threads at
/// once are permitted, except with the same `left`.
///
/// @param plan      see EnsemblePlan; signal.size() >= 2 margin.
/// @param threads   number of threads, >= 1; more than the number of blocks are not used.
/// @param progress  may be empty; called in the caller's thread with the members summed so far and
///                  those of the plan, in steps of any size; the last call has all members.
/// @throws std::bad_alloc, std::system_error  if memory or threads are not available.
/// @throws  the exceptions of progress(), after the other threads have finished all blocks.
[[nodiscard]] EnsembleSums sum_ensemble(
    const EnsemblePlan& plan, int threads,
    const std::function<void(std::size_t done, std::size_t members)>& progress);

}  // namespace a351::corrector::eemd
