#pragma once
/// @file
/// Empirical mode decomposition (EMD) of one series: the sifting itself.
/// N. E. Huang et al., Proc. R. Soc. A 454, 903-995, 1998.  Choices that the paper leaves open:
/// eemd.md.
///
/// EMD writes a series as a sum of modes and a residue.  The modes oscillate about zero, the
/// fastest first; the residue is the slow rest.  One mode is found by sifting:
///
///     curve <- series
///     curve <- curve - (upper envelope + lower envelope) / 2      several times
///     mode = curve,  series <- series - mode
///
/// The envelopes are cubic splines through the maxima and through the minima (mean_envelope.hpp),
/// with knots added at the ends (EndRule).
///
/// Use eemd() for a decomposition: it checks its arguments and adds noise.  Use EmdWorkspace to
/// decompose many series of one length, or to stop after some modes:
///
///     EmdWorkspace emd(series.size());
///     std::copy(series.begin(), series.end(), emd.residue().begin());
///     for (int k = 0; k < 5; ++k) {
///         const std::span<const double> mode = emd.next_mode({});
///         if (mode.empty()) break;  // the residue is what emd.residue() contains now
///         use(mode);                // before the next call
///     }

#include <cstddef>
#include <span>
#include <variant>

#include "corrector/eemd/aligned_buffer.hpp"
#include "corrector/eemd/knots.hpp"
#include "corrector/eemd/mean_envelope.hpp"
#include "corrector/eemd/sift_kernels.hpp"

namespace a351::corrector::eemd {

/// Does the same number of sifts for every mode, so that the members of an ensemble are comparable.
/// The time is predictable too.  Ten sifts act on white noise like a bank of octave filters
/// (tests/unit/eemd/laws_test.cpp); it is the number of Wu and Huang, 2009.
struct FixedSifts {
    int count = 10;  ///< Sifts per mode, 1 ... kMaxSifts.
};

/// Stops after `repeats` consecutive sifts in each of which the number of maxima plus minima
/// changed by at most one, if every maximum is above zero and every minimum below.  Source: N. E.
/// Huang et al., Proc. R. Soc. A 459, 2317-2345, 2003 (S-number).
///
/// The number of sifts then differs between the modes and between the members of an ensemble.  A
/// mode that never fulfils the rule ends after kMostSNumberSifts sifts.
struct SNumber {
    int repeats = 4;  ///< Consecutive sifts without a greater change, >= 1.
};

/// Most sifts per mode by the rule SNumber.  Reason: libeemd's tables are made with it
/// (tests/golden/emd).
inline constexpr int kMostSNumberSifts = 50;

/// Rule that ends the sifting of one mode.  A default-constructed one is FixedSifts with ten sifts.
using StoppingRule = std::variant<FixedSifts, SNumber>;

/// Most sifts per mode that a rule may ask for.  Reason: no decomposition can run for ever.
/// Checked by eemd() and eemd_trend(), not by EmdWorkspace.
inline constexpr int kMaxSifts = 10000;

/// The condition under which the rest of the signal becomes the residue.
///
/// `always` gives libeemd's behaviour, for comparisons.  It splits a bow off a monotone trend, so a
/// trend should be computed with the default (emd_test.cpp).
enum class FinishRule {
    at_most_two_extrema,  ///< At most two interior extrema are left; the remaining modes are zero.
    always,               ///< All modes have been sifted out, even from a monotone rest.
};

/// Options of one decomposition without noise.
/// A default-constructed object has the defaults of Options.
struct SiftOptions {
    /// Rule that ends a mode; FixedSifts::count and SNumber::repeats >= 1, which is not checked.
    StoppingRule stopping = FixedSifts{};
    /// Condition under which next_mode() returns no further mode.
    FinishRule finish = FinishRule::at_most_two_extrema;
    /// Continuation of the envelopes at both ends of the series.
    EndRule ends = EndRule::line;
};

/// Decomposes series of one length, one after the other, in place.
///
/// Write a series to residue(), then call next_mode() for the fastest mode, the next one and so on.
/// Only the constructor allocates (tests/unit/eemd/allocation_test.cpp).
///
/// The result depends on the series and the options only, not on the series before.  Reversed in
/// time, a series has its modes reversed, to rounding (emd_test.cpp, laws_test.cpp).
///
/// An object may be used by one thread at a time; objects do not share data.  It needs about 12
/// doubles per sample.  It can be moved, but not copied.
class EmdWorkspace {
public:
    /// Allocates everything for series of one length; the residue is zero.
    /// @param sample_count  length of the series, any; shorter than 2 there are no modes.
    /// @param kernels       loops of one instruction set; every set gives the same bits
    ///                      (tests/unit/eemd/sift_kernels_test.cpp).
    ///                      A reference is kept.  The tables of sift_kernels.hpp live as long as
    ///                      the program.
    /// @throws std::bad_alloc  if there is not so much memory.
    explicit EmdWorkspace(std::size_t sample_count, const SiftKernels& kernels = fastest_kernels());

    /// Returns the buffer of the series, (sample_count).  The caller writes the series to it; each
    /// next_mode() subtracts a mode from it.
    /// The span is valid as long as the workspace.  The unit is free, and modes have the same.
    /// Scale large series to magnitudes near 1, as eemd() does: products within a sift could
    /// overflow otherwise.
    [[nodiscard]] std::span<double> residue() noexcept { return {residue_.data(), sample_count_}; }

    /// Sifts the fastest mode out of the residue and subtracts it there.
    ///
    /// A sift subtracts the mean of the upper and the lower envelope from the curve.  The residue
    /// must be finite; this is not checked.
    /// NaN or infinite samples give an undefined mode.
    ///
    /// Half a period of the mode next to either end is extrapolation.  The mode and the new residue
    /// add up to the residue before, to rounding.  The time is O(n) per sift.
    ///
    /// With FinishRule::always a mode is returned at every call, even from a monotone or constant
    /// residue.  The caller must limit the number of calls then.
    /// @param options  see SiftOptions; they may differ from call to call.
    /// @return the mode (sample_count), valid until the next call; empty if the residue is
    ///         finished, or shorter than two samples.  The residue is unchanged then.
    [[nodiscard]] std::span<const double> next_mode(const SiftOptions& options) noexcept;

private:
    void find_extrema(const double* curve) noexcept;
    void sift(const double* curve, EndRule ends) noexcept;
    [[nodiscard]] bool has_extrema_of_correct_sign() const noexcept;

    const SiftKernels& kernels_;
    std::size_t sample_count_;
    AlignedBuffer residue_;
    AlignedBuffer mode_;
    AlternatingKnots knots_;
    MeanEnvelope envelope_;
};

}  // namespace a351::corrector::eemd
