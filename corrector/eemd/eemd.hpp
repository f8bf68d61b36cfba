#pragma once
/// @file
/// Ensemble empirical mode decomposition (EEMD) of one regularly sampled series.
/// Z. Wu and N. E. Huang, Adv. Adapt. Data Anal. 1(1), 1-41, 2009, doi:10.1142/S1793536909000047.
/// Choices that the paper leaves open (spline ends, stopping, mode count): corrector/eemd/eemd.md.
///
/// The decomposition writes a series as a sum of modes and a residue.  Each mode oscillates about
/// zero with a slowly varying period; the residue is the slow rest.  No period is chosen
/// beforehand.  Noise is added to many copies of the series and averages out.  It separates an
/// intermittent wave from slower ones, which plain EMD mixes (tests/unit/eemd/laws_test.cpp).
///
/// Use eemd() for all modes with their standard errors, and eemd_trend() for the slow part alone.
/// The series must have no gaps.  Despike it first: no treatment makes up for a disturbed end.
///
///     Options options;
///     options.threads = 4;
///     const Result result = eemd(series, options);
///     for (const Component& mode : result.modes) {
///         const double period_s = mode.mean_period_samples * step_s;
///         ...
///     }
///
/// Do not choose a mode by its number: the number of a given period depends on the noise and the
/// sifts.  Choose it by mean_period_samples or extrema_count.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "corrector/eemd/emd.hpp"

namespace a351::corrector::eemd {

/// Options of eemd() and eemd_trend().
///
/// The default values are valid for every signal.  The options are checked before any work; a value
/// out of range is refused by name.
struct Options {
    int ensemble_size = 80;  ///< Members that are averaged, >= 1; each has its own noise.
    /// Standard deviation of the added noise, divided by that of the signal (divisor n - 1, trend
    /// included); finite, >= 0.  0 is plain EMD with one member.
    /// Without noise the size of the ensemble and the seed have no effect.
    double noise_ratio = 0.1;
    /// Uses every noise twice, the second time negated, so that the noises cancel in the sum of the
    /// components.  Needs an even ensemble_size.  Slow modes scatter more, because there are half
    /// as many different noises.
    /// Source: J.-R. Yeh, J.-S. Shieh and N. E. Huang, Adv. Adapt. Data Anal. 2(2), 135-156, 2010.
    bool complementary_pairs = false;
    /// Rule that ends the sifting of a mode.  Limits: FixedSifts::count 1 to kMaxSifts,
    /// SNumber::repeats >= 1.  Fixed sifts make the members comparable, and the time predictable.
    StoppingRule stopping = FixedSifts{};
    /// Number of modes without the residue, >= 0; absent: default_mode_count().
    /// Modes beyond those that the signal has are zero.  With reflect_ends the default is still
    /// that of the signal's own length.
    std::optional<int> mode_count = std::nullopt;
    /// Condition under which the rest of a member becomes its residue.
    FinishRule finish = FinishRule::at_most_two_extrema;
    /// Continuation of the envelopes at the ends.  The line compares with the literature; the
    /// mirror has smaller errors at the ends.
    EndRule ends = EndRule::line;
    /// Decomposes the record with half its length reflected at either end.  This is twice the work,
    /// and best if the ends are disturbed (eemd.md, "Ends").
    bool reflect_ends = false;
    std::uint64_t seed = 0;  ///< Seed of the noise; the same seed gives the same bits.
    int threads = 1;         ///< Number of threads, >= 1; the result does not depend on it.
    /// Called in the caller's thread with the members done, in steps of any size, and with the
    /// number of all members.
    /// Empty: no reports.  Without noise there is one member.  The last call has `done` equal to
    /// `members`.
    std::function<void(std::size_t done, std::size_t members)> progress;
};

/// One mode, or the residue, averaged over the ensemble.
/// A default-constructed component is empty.
struct Component {
    std::vector<double> values;        ///< (n), unit of the signal.
    std::size_t extrema_count = 0;     ///< Interior maxima and minima of `values`.
    double mean_period_samples = 0.0;  ///< 2 n / extrema_count, samples; infinite without extrema.
    /// Variance of this component about its own mean, divided by the sum of all components'
    /// variances.  The shares add up to 1; all are 0 for a constant signal.
    /// Modes are nearly, not exactly, orthogonal.  Hence it is not exactly the share of the
    /// signal's variance.
    double energy_share = 0.0;
    /// Standard error of the ensemble mean, rms over the samples, unit of the signal.  It comes
    /// from the scatter of the draws; a draw is a member, or a complementary pair of members.
    ///
    /// Lower limit: 1e-7 of the component's rms (for the residue: of its deviation from the
    /// signal's mean), divided by the root of the number of draws.  Below it there is only
    /// rounding.  Absent with fewer than two draws, and for an empty signal.
    ///
    /// It is the uncertainty due to the added noise only.  Not included are errors at the ends of
    /// the record, and noise that the signal itself contains.
    std::optional<double> standard_error;
};

/// A decomposition: the modes and the residue.
///
/// Invariant: modes.size() is the number of modes that was asked for, and every component has the
/// length of the signal.
struct Result {
    std::vector<Component> modes;  ///< Modes, the fastest first; zero if no member had one left.
    Component residue;             ///< Rest after all modes were removed.
    double noise_level = 0.0;      ///< Std. deviation of the added noise, unit of the signal.
};

/// Returns the default number of modes without the residue: floor(log2(n)) - 1, and 0 for n < 4.
/// Examples: 1 for n = 4, 4 for 63, 5 for 64 (emd_test.cpp), 7 for 450.
/// Source: Wu and Huang, 2009.
[[nodiscard]] int default_mode_count(std::size_t n) noexcept;

/// Decomposes a signal into modes and a residue, averaged over an ensemble.
///
/// Member m is the EMD of signal + noise_level w_m, where w_m is white Gaussian noise of variance 1
/// and noise_level = noise_ratio x standard deviation of the signal.  A component is the mean of
/// this component over all members.  Every member has the same number of modes; modes that it does
/// not have are zero.
///
/// - The sum of all components differs from the signal by the mean of the added noise, about
///   noise_level / sqrt(members).
/// - Half a period of every mode next to either end is extrapolation.
/// - Without noise there is one member, and standard errors are absent.
/// - A constant signal gets no noise.  Its modes are zero, and the residue is the signal bit for
///   bit (degenerate_test.cpp).
/// - For n < 4 there are no modes by default: the residue is the signal with the mean noise.
/// - A signal scaled by a power of two has components with the same digits; other factors change
///   rounding only (eemd_test.cpp).
/// - The result has the same bits on any number of threads and with every instruction set.
/// - A constant added to the signal appears in the residue only, to rounding (eemd_test.cpp).
/// - A monotone signal is its own residue without noise, unless FinishRule::always (emd_test.cpp).
///
/// The time is proportional to members x modes x sifts x n.  One sift takes 0.95 to 2.2 ns per
/// sample on one core of a Zen 4, depending on the instruction set (eemd.md).  Each thread needs
/// about 13 + modes doubles per sample.  The function has no state: several threads may call it at
/// once.
///
/// Accuracy, and the tests that show it:
/// - With noise_ratio = 0 the components add up to the signal within 8 units in the last place per
///   component (tests/unit/eemd/emd_test.cpp), with complementary pairs within 1e-12 of the
///   signal's rms (eemd_test.cpp).
/// - Plain EMD agrees with libeemd within ten times the difference between two builds of libeemd:
///   6e-15 to 5e-6 of the rms about the mean, depending on record and stopping rule
///   (reference_test.cpp).
/// - The stated standard error agrees with the scatter of 40 ensembles within 20 % (eemd_test.cpp).
///
/// @param signal   (n) samples at constant rate without gaps, any unit, finite, |signal| < 1e300;
///                 any n, also 0.  NaN is refused.
/// @param options  see Options; `progress` is called by the calling thread only.
/// @return components of n samples each, in the unit of the signal.
/// @throws std::invalid_argument  naming the argument, its value and its limit; a bad sample is
///                                named by its index.
/// @throws std::bad_alloc, std::system_error  if memory or threads are not available.
/// @throws  the exceptions of `options.progress`.
[[nodiscard]] Result eemd(std::span<const double> signal, const Options& options = {});

/// The slow part of a series.
/// The values are the rest of the ensemble after `removed_modes` modes, averaged over the members.
struct Trend {
    std::vector<double> values;  ///< (n), unit of the signal.
    int removed_modes = 0;       ///< Number of modes removed from the signal.
};

/// Returns the residue of eemd() after the smallest number of modes that leaves at most
/// `most_extrema` extrema in it.
///
/// If no number up to the mode count of the options does, the residue after all modes is returned.
/// Check the values with count_extrema() if the limit matters.
/// Slower modes are never computed.  The values have the same bits as the residue of eemd() with
/// this mode_count, for every option and any number of threads (tests/unit/eemd/trend_test.cpp).
///
/// A mode is removed from all members before the next one.  Therefore ensemble_size copies of the
/// signal are kept in memory (twice that with reflect_ends).  `options.progress` counts the members
/// again for every mode.
///
/// Accuracy: the rms error is 0.091 of a wave's amplitude with most_extrema = 7 and the default
/// options.  It is taken over 16 simulated records of 450 samples with a drift, the wave, and
/// white noise of half its amplitude (tests/unit/reading/trend_curve_test.cpp).
///
/// @param signal        as eemd().
/// @param most_extrema  largest number of interior extrema of the result; 7 for the trend of an
///                      occupation (eemd.md, "The trend alone").
/// @param options       as eemd(); mode_count limits the number of modes removed.
/// @return the trend; no mode is removed if the mean of the members already has few extrema.
/// @throws              as eemd().
[[nodiscard]] Trend eemd_trend(std::span<const double> signal, std::size_t most_extrema,
                               const Options& options = {});

}  // namespace a351::corrector::eemd
