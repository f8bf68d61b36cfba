#pragma once
/// @file
/// Penalised least squares with second differences, by one banded factorisation.

#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector {

/// The penalty with which a fit to complete data halves a sine of period P samples (its gain is
/// 1 / (1 + lambda (2 sin(pi / P))^4)):
///
///     lambda = 1 / (2 sin(pi / P))^4
[[nodiscard]] double penalty_of(double cutoff_period) noexcept;

/// A = W + lambda D' D = L diag(d) L', with W the weights on the diagonal and D the second
/// differences, pentadiagonal.  The curve z that minimises
///
///     sum of w[i] (y[i] - z[i])^2 + lambda sum of (z[i] - 2 z[i + 1] + z[i + 2])^2
///
/// solves A z = W y.  Time and memory: O(n).
/// Source: E. T. Whittaker, Proc. Edinb. Math. Soc. 41, 63-75, 1923; in matrices P. H. C. Eilers,
/// Anal. Chem. 75(14), 3631-3636, 2003.
class PenalisedFit {
public:
    /// @param weights  (n) >= 0, n >= 3.
    /// @param penalty  lambda > 0
    /// @throws std::invalid_argument  the weights do not determine the curve to 1 %: fewer than two
    ///                                are positive, or gaps or ends are much longer than the cut-off.
    PenalisedFit(std::span<const double> weights, double penalty);

    /// x of A x = right_side, (n), refined once: for cut-offs of 1000 and 5000 samples to 1e-12 and
    /// 1e-7 relative, where the factors alone give 1e-6 and 3e-4.
    [[nodiscard]] std::vector<double> solve(std::span<const double> right_side) const;

    /// Diagonal of the inverse of A, (n), without the rest of it; to 1e-6 and 3e-4 relative for
    /// cut-offs of 1000 and 5000 samples.
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
