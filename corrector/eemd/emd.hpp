#pragma once
/// @file
/// Empirical mode decomposition (EMD) of one series: the sifting itself.
/// N. E. Huang et al., Proc. R. Soc. A 454, 903-995, 1998.  Choices it leaves open: eemd.md.

#include <cstddef>
#include <span>
#include <variant>

#include "corrector/eemd/aligned_buffer.hpp"
#include "corrector/eemd/knots.hpp"
#include "corrector/eemd/mean_envelope.hpp"
#include "corrector/eemd/sift_kernels.hpp"

namespace a351::corrector {

/// The same number of sifts for every mode: comparable between members of an ensemble.
struct FixedSifts {
    int count = 10;  ///< 1 ... kMaxSifts
};

/// Sift until the number of extrema has changed by at most one, `repeats` times in a row, and
/// every maximum lies above zero and every minimum below.
/// Source: N. E. Huang et al., Proc. R. Soc. A 459, 2317-2345, 2003 (S-number).
struct SNumber {
    int repeats = 4;     ///< >= 1
    int max_sifts = 50;  ///< 1 ... kMaxSifts
};

using StoppingRule = std::variant<FixedSifts, SNumber>;

/// No rule sifts more often than this, so that none can run for ever.
inline constexpr int kMaxSifts = 10000;

/// When what is left of the signal is the residue.
enum class FinishRule {
    at_most_two_extrema,  ///< With two interior extrema or fewer; the modes still due are zero.
    always,               ///< Every mode is sifted out, even from a monotone rest.
};

struct SiftOptions {
    StoppingRule stopping = FixedSifts{};
    FinishRule finish = FinishRule::at_most_two_extrema;
    EndRule ends = EndRule::line;
    SplineEnds spline_ends = SplineEnds::not_a_knot;
};

/// Decomposes series of one length one after the other; allocates in the constructor alone.
class EmdWorkspace {
public:
    explicit EmdWorkspace(std::size_t sample_count, const SiftKernels& kernels = fastest_kernels());

    /// The series to decompose is written here; what no mode has taken yet is left here.
    [[nodiscard]] std::span<double> residue() noexcept { return {residue_.data(), sample_count_}; }

    /// Sifts the fastest mode out of the residue, which must be finite.
    /// @return the mode, until the next call; empty when the residue is finished.
    [[nodiscard]] std::span<const double> next_mode(const SiftOptions& options) noexcept;

private:
    void find_extrema(const double* curve) noexcept;
    void sift(const double* curve, const SiftOptions& options) noexcept;
    [[nodiscard]] bool has_extrema_of_correct_sign() const noexcept;

    const SiftKernels& kernels_;
    std::size_t sample_count_;
    AlignedBuffer residue_;
    AlignedBuffer mode_;
    AlternatingKnots knots_;
    MeanEnvelope envelope_;
};

}  // namespace a351::corrector
