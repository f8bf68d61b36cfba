#pragma once
/// @file
/// Penalised least squares with second differences, by one banded factorisation.
///
/// Use smooth() (smoother.hpp) for a series with outliers or unknown noise: it finds the weights
/// and the noise level.  Use PenalisedFit if the weights are known, or for the variance of the
/// curve:
///
///     const PenalisedFit fit(weights, penalty_of(150.0));
///     std::vector<double> right(n);  // W y; stays 0 where a sample is missing
///     for (std::size_t i = 0; i < n; ++i)
///         if (weights[i] > 0.0) right[i] = weights[i] * series[i];
///     const std::vector<double> curve = fit.solve(right);
///     const std::vector<double> variance = fit.inverse_diagonal();  // times the noise variance

#include <span>
#include <vector>

namespace a351::corrector::reading {

/// Returns the penalty that halves a sine of period P samples in a fit to complete data:
///
///     lambda = 1 / (2 sin(pi / P))^4
///
/// The gain of the fit is 1 / (1 + lambda (2 sin(pi / P))^4); tests/unit/reading/smoother_test.cpp
/// finds 1/2 to 1e-9.
/// lambda grows like (P / (2 pi))^4: 1/16 for P = 2, 6.4e8 for P = 1000, 4.0e11 for P = 5000.
/// @param cutoff_period  P in samples, >= 2; not checked.  NaN gives NaN, infinity gives infinity;
///                       below 2 no wave of samples has this period.
/// @return lambda, without unit.
[[nodiscard]] double penalty_of(double cutoff_period) noexcept;

/// Fits curves by penalised least squares.  The curve z that minimises
///
///     sum of w[i] (y[i] - z[i])^2 + lambda sum of (z[i] - 2 z[i + 1] + z[i + 2])^2
///
/// solves A z = W y with the pentadiagonal matrix A = W + lambda D' D = L diag(d) L'.  W has the
/// weights on its diagonal, and D takes second differences.
///
/// Sums of both kinds have the unit of y squared; weights and lambda have no unit.  Across a gap of
/// zero weights the curve is a cubic, and beyond the outermost positive weight it is a straight
/// line.  A straight line is reproduced, apart from rounding.
///
/// An object owns copies of the weights and the factors.  It can be copied, and is constant after
/// construction, so several threads may use it.
///
/// Time and memory are O(n).  For cut-offs up to 100 samples, solutions and inverse agree with a
/// dense solution of 64-bit mantissa to 1e-10 (tests/unit/reading/smoother_test.cpp).
/// Source: E. T. Whittaker, Proc. Edinb. Math. Soc. 41, 63-75, 1923; in matrices P. H. C. Eilers,
/// Anal. Chem. 75(14), 3631-3636, 2003.
class PenalisedFit {
public:
    /// Factorises A.
    /// @param weights  (n) finite, >= 0; 0 for a missing sample; n >= 3.  NaN and infinity are
    ///                 refused, negative weights are not checked, and n >= 3 is asserted.
    /// @param penalty  lambda, finite, see penalty_of(); > 0 is asserted.
    /// @throws std::invalid_argument  the weights do not determine the curve to 1 %: fewer than two
    ///                                are positive, or gaps or ends are much longer than the
    ///                                cut-off.
    ///                                Limit: gaps of some 50 cut-offs for a cut-off of 150
    ///                                samples, of one cut-off for 5000.
    PenalisedFit(std::span<const double> weights, double penalty);

    /// Returns x of A x = right_side, refined once.
    ///
    /// Relative accuracy: 1e-12 for a cut-off of 1000 samples and 1e-7 for 5000; the factors alone
    /// give 1e-6 and 3e-4.  smoother_test.cpp checks it to 1e-8 for 1000 samples.
    /// The time is O(n); a few vectors of n doubles are allocated.  The result does not depend on
    /// earlier calls.
    /// @param right_side  (n), any unit, finite; the size is asserted.  A NaN spreads to every
    ///                    element, so a missing sample must be 0 here.
    /// @return (n), in the unit of right_side.
    [[nodiscard]] std::vector<double> solve(std::span<const double> right_side) const;

    /// Returns the diagonal of the inverse of A, (n), without computing the rest of the inverse.
    ///
    /// Element i is the variance of the curve at sample i if the noise of a sample of weight 1 has
    /// variance 1, see smooth().  It has no unit and is positive; in gaps and beyond the ends it is
    /// larger.  The time is O(n).  Samples of weight 0 have an element too.
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

}  // namespace a351::corrector::reading
