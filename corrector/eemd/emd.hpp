#pragma once
/// @file
/// Empirical mode decomposition (EMD) of one series: the sifting itself.
/// N. E. Huang et al., Proc. R. Soc. A 454, 903-995, 1998.  Choices that the paper leaves open:
/// eemd.md.

#include <cstddef>
#include <span>
#include <variant>

#include "corrector/eemd/aligned_buffer.hpp"
#include "corrector/eemd/knots.hpp"
#include "corrector/eemd/mean_envelope.hpp"
#include "corrector/eemd/sift_kernels.hpp"

namespace a351::corrector {

/// Does the same number of sifts for every mode, so that the members of an ensemble are comparable.
struct FixedSifts {
    int count = 10;  ///< Sifts per mode, 1 ... kMaxSifts.
};

/// Stops when the numbers of maxima and of minima have together changed by at most one in each of
/// `repeats` consecutive sifts, and every maximum is above zero and every minimum below.
/// Source: N. E. Huang et al., Proc. R. Soc. A 459, 2317-2345, 2003 (S-number).
struct SNumber {
    int repeats = 4;  ///< Consecutive sifts without a greater change, >= 1.
};

/// Most sifts per mode by the rule SNumber.  Reason: libeemd's tables are made with it
/// (tests/golden/emd).
inline constexpr int kMostSNumberSifts = 50;

using StoppingRule = std::variant<FixedSifts, SNumber>;

/// Most sifts per mode that a rule may ask for.  Reason: no decomposition can run for ever.
inline constexpr int kMaxSifts = 10000;

/// The condition under which the rest of the signal becomes the residue.
enum class FinishRule {
    at_most_two_extrema,  ///< At most two interior extrema are left; the remaining modes are zero.
    always,               ///< All modes have been sifted out, even from a monotone rest.
};

/// Options of one decomposition without noise.
struct SiftOptions {
    StoppingRule stopping = FixedSifts{};
    FinishRule finish = FinishRule::at_most_two_extrema;
    EndRule ends = EndRule::line;
};

/// Decomposes series of one length, one after the other, in place.
///
/// Write a series to residue(), then call next_mode() for the fastest mode, the next one and so on.
/// Only the constructor allocates (tests/unit/eemd/allocation_test.cpp).
class EmdWorkspace {
public:
    /// @param sample_count  length of the series, any; shorter than 2 there are no modes.
    /// @param kernels       loops of one instruction set; every set gives the same bits
    ///                      (tests/unit/eemd/sift_kernels_test.cpp).
    explicit EmdWorkspace(std::size_t sample_count, const SiftKernels& kernels = fastest_kernels());

    /// Returns the buffer of the series, (sample_count).  The caller writes the series to it; each
    /// next_mode() subtracts a mode from it.
    [[nodiscard]] std::span<double> residue() noexcept { return {residue_.data(), sample_count_}; }

    /// Sifts the fastest mode out of the residue and subtracts it there.
    ///
    /// A sift subtracts the mean of the upper and the lower envelope from the curve.  The residue
    /// must be finite; this is not checked.
    /// @return the mode (sample_count), valid until the next call; empty if the residue is
    ///         finished, or shorter than two samples.
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

}  // namespace a351::corrector
