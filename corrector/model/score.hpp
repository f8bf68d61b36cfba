#pragma once
/// @file
/// Scores of a model, and how sure they are.  All functions are pure.
///
/// Methods: corrector/methods.md, "Linear models".

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace a351::corrector::model {

/// Root mean square errors of a model, mGal.  A score is absent if it is not defined for so few
/// rows, or for this model.
///
/// `rms_mgal` and `s_mgal` are in sample: the fit has seen these rows.  `loso_mgal` is the error to
/// expect at a station of unknown gravity; compare models by it.
struct Score {
    std::string model;                ///< Name of the model.
    std::size_t row_count = 0;        ///< Number of rows n.
    std::size_t parameter_count = 0;  ///< Number of coefficients p, steps included.
    /// Degrees of freedom of the residuals: n + rows of priors and datum - p.  `paper` and
    /// `day` have n - p, at least 0.
    std::size_t dof = 0;
    std::optional<double> rms_mgal;   ///< In sample, sqrt(RSS / n).
    std::optional<double> s_mgal;     ///< In sample, divisor dof instead of n.
    std::optional<double> loo_mgal;   ///< Leave-one-out: each row predicted without it.
    std::optional<double> loso_mgal;  ///< Each row predicted without the rows of its station.
    /// AICc = n ln(RSS/n) + 2K + 2K(K+1)/(n-K-1), K = p + 1 (C. M. Hurvich and C.-L. Tsai,
    /// Biometrika 76, 297-307, 1989).  Absent for a model with a prior, because p would then count
    /// too much.
    std::optional<double> aicc;
    std::optional<double> rms_before_drift_mgal;  ///< `paper` only: rms of Error (1).
};

/// Returns the root of the mean of the squares; std::nullopt without values.
[[nodiscard]] std::optional<double> root_mean_square(const std::vector<double>& values);

/// Limits of a confidence interval, in the unit of the quantity.
struct Interval {
    double low = 0.0;   ///< Lower limit.
    double high = 0.0;  ///< Upper limit, at least `low`.
};

/// Number of bootstrap draws.  Reason: enough for the second digit of the limits.
inline constexpr int kBootstrapDraws = 1000;

/// Returns the 95 % bootstrap interval of the root mean square error sqrt(sum e^2 / n).
///
/// Each of kBootstrapDraws draws takes as many stations as there are, with replacement, and each
/// station with all its rows.  The limits are the 2.5 % and 97.5 % percentiles of the draws.
/// Stations and not rows are drawn, because rows of one station have an error in common.
/// The generator is std::mt19937_64: the same seed gives the same interval on any machine.
///
/// Accuracy: agrees with the normal approximation for 400 stations within 0.01, and for 100
/// stations of four rows each within 0.02, for an rms of 1.414 (bootstrap_test.cpp).
/// @param errors    (n) finite, any unit.
/// @param stations  (n) name of the station of each error.
/// @param seed      seed of the draws.
/// @return limits in the unit of the errors; std::nullopt for fewer than two different stations.
[[nodiscard]] std::optional<Interval> bootstrap_rms_interval(
    const std::vector<double>& errors, const std::vector<std::string>& stations,
    std::uint64_t seed);

/// Returns the 95 % bootstrap interval of a mean, drawn by station as in bootstrap_rms_interval().
///
/// For a paired comparison of two models give the differences of their squared errors.  Accuracy:
/// tested through bootstrap_rms_interval(), which takes the root of the interval of the squares.
/// @param values    (n) finite, any unit.
/// @param stations  (n) name of the station of each value.
/// @param seed      seed of the draws.
/// @return limits in the unit of the values; std::nullopt for fewer than two different stations.
[[nodiscard]] std::optional<Interval> bootstrap_mean_interval(
    const std::vector<double>& values, const std::vector<std::string>& stations,
    std::uint64_t seed);

/// The model that was chosen, and the limit that it had to meet.
struct Choice {
    std::string model;        ///< Name of the model.
    double limit_mgal = 0.0;  ///< Least LOSO plus its standard error.
};

}  // namespace a351::corrector::model
