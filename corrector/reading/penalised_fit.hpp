#pragma once
/// @file
/// Penalised least squares with second differences, by one banded factorisation.

#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector {

/// Returns the penalty that halves a sine of period P samples in a fit to complete data:
///
///     lambda = 1 / (2 sin(pi / P))^4
///
/// The gain of the fit is 1 / (1 + lambda (2 sin(pi / P))^4); tests/unit/reading/smoother_test.cpp
/// finds 1/2 to 1e-9.
/// @param cutoff_period  P in samples, >= 2.
/// @return lambda, without unit.
[[nodiscard]] double penalty_of(double cutoff_period) noexcept;

/// Fits curves by penalised least squares.  The curve z that minimises
///
///     sum of w[i] (y[i] - z[i])^2 + lambda sum of (z[i] - 2 z[i + 1] + z[i + 2])^2
///
/// solves A z = W y with the pentadiagonal matrix A = W + lambda D' D = L diag(d) L'.  W has the
/// weights on its diagonal, and D takes second differences.
///
/// Time and memory are O(n).  For cut-offs up to 100 samples, solutions and inverse agree with a
/// dense solution of 64-bit mantissa to 1e-10 (tests/unit/reading/smoother_test.cpp).
/// Source: E. T. Whittaker, Proc. Edinb. Math. Soc. 41, 63-75, 1923; in matrices P. H. C. Eilers,
/// Anal. Chem. 75(14), 3631-3636, 2003.
class PenalisedFit {
public:
    /// Factorises A.
    /// @param weights  (n) finite, >= 0; 0 for a missing sample; n >= 3.
    /// @param penalty  lambda > 0, see penalty_of().
    /// @throws std::invalid_argument  the weights do not determine the curve to 1 %: fewer than two
    ///                                are positive, or gaps or ends are much longer than the
    ///                                cut-off.
    PenalisedFit(std::span<const double> weights, double penalty);

    /// Returns x of A x = right_side, refined once.
    ///
    /// Relative accuracy: 1e-12 for a cut-off of 1000 samples and 1e-7 for 5000; the factors alone
    /// give 1e-6 and 3e-4.  smoother_test.cpp checks it to 1e-8 for 1000 samples.
    /// @param right_side  (n), any unit.
    /// @return (n), in the unit of right_side.
    [[nodiscard]] std::vector<double> solve(std::span<const double> right_side) const;

    /// Returns the diagonal of the inverse of A, (n), without computing the rest of the inverse.
    ///
    /// Relative accuracy: 1e-6 for a cut-off of 1000 samples, 3e-4 for 5000.
    /// Source: M. F. Hutchinson and F. R. de Hoog, Numer. Math. 47, 99-106, 1985.
    [[nodiscard]] std::vector<double> inverse_diagonal() const;

private:
    [[nodiscard]] bool returns_line() const;
    [[nodiscard]] std::vector<double> substitute(std::vector<double> x) const;
    [[nodiscard]] std::vector<double> remainder(std::span<const double> right_side,
                                                std::span<const double> x) const;

    std::vector<double> weights_;
    double penalty_;
    std::vector<double> diagonal_;  ///< d[i]
    std::vector<double> below_;     ///< L[i + 1][i]
    std::vector<double> below2_;    ///< L[i + 2][i]
};

}  // namespace a351::corrector
