#pragma once
/// @file
/// Ensemble empirical mode decomposition (EEMD) of one regularly sampled series.
/// Z. Wu and N. E. Huang, Adv. Adapt. Data Anal. 1(1), 1-41, 2009, doi:10.1142/S1793536909000047.
/// What the paper leaves open (spline ends, stopping, mode count): corrector/eemd/eemd.md.

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "corrector/eemd/emd.hpp"

namespace a351::corrector {

struct EemdOptions {
    int ensemble_size = 80;    ///< Noise realisations averaged, >= 1.
    double noise_ratio = 0.1;  ///< Std. deviation of added noise / of signal, >= 0; 0 is plain EMD.
    /// Every noise is used twice, the second time negated, so that it leaves nothing in the sum of
    /// the components; needs an even ensemble_size.  Slow modes scatter more: half as many noises.
    /// Source: J.-R. Yeh, J.-S. Shieh and N. E. Huang, Adv. Adapt. Data Anal. 2(2), 135-156, 2010.
    bool complementary_pairs = false;
    StoppingRule stopping = FixedSifts{};
    std::optional<int> mode_count =
        std::nullopt;  ///< Without the residue, >= 0; absent: default_mode_count().
    FinishRule finish = FinishRule::at_most_two_extrema;
    EndRule ends = EndRule::line;
    SplineEnds spline_ends = SplineEnds::not_a_knot;
    /// Decompose the record with half its length reflected at either end: twice the work, best
    /// where the ends are disturbed (eemd.md, "Ends").
    bool reflect_ends = false;
    std::uint64_t seed = 0;  ///< Same seed, same bits, on any thread count.
    int threads = 1;         ///< >= 1
    /// Called in the caller's thread with the members done and their number; false cancels.
    std::function<bool(int done, int members)> progress;
};

/// Thrown by eemd() when `progress` returned false.
struct EemdCancelled : std::exception {
    [[nodiscard]] const char* what() const noexcept override { return "eemd: cancelled"; }
};

/// One mode, or the residue, averaged over the ensemble.
struct Component {
    std::vector<double> values;        ///< (n), unit of the signal.
    std::size_t extrema_count = 0;     ///< Interior maxima and minima of `values`.
    double mean_period_samples = 0.0;  ///< 2 n / extrema_count; infinite without extrema.
    /// Of the components' variances, each about its own mean; they add up to 1, or are 0 for a
    /// constant.
    double energy_share = 0.0;
    /// Standard error of the ensemble mean, rms over the samples, unit of the signal.  At least 1e-7
    /// of the component's rms (of the residue's departure from the signal's mean) over the root of
    /// the draws, which is rounding.  Absent for one member: there is nothing to estimate it from.
    std::optional<double> standard_error;
};

struct EemdResult {
    std::vector<Component> modes;  ///< The fastest first; zero where no member had one left.
    Component residue;             ///< What no mode carries.
    int members = 0;               ///< Averaged: the ensemble size, or 1 when no noise was added.
    double noise_level = 0.0;      ///< Std. deviation of the added noise, unit of the signal.
    double closure_error = 0.0;    ///< max |signal - sum of modes - residue|, unit of the signal.
};

/// floor(log2(n)) - 1, and 0 for n < 4 (Wu and Huang 2009; without the residue).
[[nodiscard]] int default_mode_count(std::size_t n) noexcept;

/// Averages the EMD of `signal` with `ensemble_size` different noises added.
///
/// The noise does not average out completely: the sum of all components differs from the signal
/// by about noise_level / sqrt(members).  Every member has the same number of modes; those it does
/// not have are zero.  Half a period of every mode next to either end is extrapolation.
///
/// @param signal  (n) samples at constant rate, any unit, finite and gap-free, |signal| < 1e300;
///                any n, also 0.
/// @throws std::invalid_argument  naming the argument, its value and its limit.
/// @throws EemdCancelled, and whatever `options.progress` throws.
[[nodiscard]] EemdResult eemd(std::span<const double> signal, const EemdOptions& options = {});

/// The slow part of a series alone.
struct EemdTrend {
    std::vector<double> values;  ///< (n), unit of the signal.
    int modes_taken_off = 0;
    double noise_level = 0.0;  ///< Std. deviation of the added noise, unit of the signal.
};

/// The residue of eemd(), the same bits, with the fewest modes that leave at most `most_extrema`
/// extrema in it; with options.mode_count modes where no fewer do.  Slower modes are never made.
///
/// All members lose a mode before any loses the next: they need ensemble_size times the memory of
/// the signal.  `options.progress` counts the members again for every mode.
///
/// @param signal, options, @throws  as eemd().
[[nodiscard]] EemdTrend eemd_trend(std::span<const double> signal, std::size_t most_extrema,
                                   const EemdOptions& options = {});

}  // namespace a351::corrector
