#pragma once
/// @file
/// Empirical mode decomposition (EMD) of one series: the sifting itself.
/// N. E. Huang et al., Proc. R. Soc. A 454, 903-995, 1998.  Choices it leaves open: eemd.md.

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "corrector/eemd/extrema.hpp"
#include "corrector/eemd/spline.hpp"

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

/// Buffers for series of one length; decompose() does not allocate.
class EmdWorkspace {
public:
    explicit EmdWorkspace(std::size_t sample_count);

    /// Writes the modes, fastest first, and then the residue.
    ///
    ///     signal = sum of modes + residue     to rounding
    ///
    /// @param signal      (n) finite samples, n as given to the constructor, any unit.
    /// @param components  (n (k + 1)), one component after the other, for k modes.
    void decompose(std::span<const double> signal, const StoppingRule& stopping, FinishRule finish,
                   std::span<double> components) noexcept;

private:
    [[nodiscard]] bool sift_out_mode(const StoppingRule& stopping, FinishRule finish,
                                     std::span<double> mode) noexcept;
    void subtract_mean_envelope(std::span<double> curve) noexcept;
    [[nodiscard]] bool has_extrema_of_correct_sign() const noexcept;

    EnvelopeKnots maxima_;
    EnvelopeKnots minima_;
    NotAKnotSpline spline_;
    std::vector<double> envelope_;
};

}  // namespace a351::corrector
