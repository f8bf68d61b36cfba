#pragma once
/// @file
/// Quantiles and tail probabilities of the normal distribution, of Student's t and of chi-square, for
/// limits of confidence and tests.
///
/// Boost's templates are compiled once, in the source: each file that includes them costs seconds.
///
/// The functions of the upper tail are accurate also where the probability q is so small that 1 - q
/// has lost it.  They differ from those of 1 - q in the last bits.
///
/// Errors: std::domain_error if the degrees of freedom are not finite and above 0, or a probability
/// is not between 0 and 1.  They need not be whole.
///
/// Accuracy: tables of ten digits are reproduced, and the functions of both tails agree within 1e-12
/// (distributions_test.cpp).
/// Source: Boost.Math, in double precision on every architecture (BOOST_MATH_PROMOTE_DOUBLE_POLICY).

namespace a351::signal {

/// 95 % of a normal distribution are within this many standard deviations of its mean: its quantile
/// of 0.975, 1.959964, rounded.
inline constexpr double kNormal95 = 1.96;

/// Returns the value that Student's t with `dof` degrees of freedom exceeds with probability 1 - p.
[[nodiscard]] double students_t_quantile(double dof, double p);
/// Returns the probability that Student's t exceeds t.
[[nodiscard]] double students_t_exceedance(double dof, double t);

/// Returns the value that chi-square with `dof` degrees of freedom exceeds with probability 1 - p.
[[nodiscard]] double chi_square_quantile(double dof, double p);
/// Returns the value that chi-square exceeds with probability q.
[[nodiscard]] double chi_square_upper_quantile(double dof, double q);
/// Returns the probability that chi-square exceeds x.
/// @param x  >= 0; otherwise std::domain_error.
[[nodiscard]] double chi_square_exceedance(double dof, double x);

}  // namespace a351::signal
