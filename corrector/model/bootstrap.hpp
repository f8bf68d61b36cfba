#pragma once
/// @file
/// Bootstrap interval of a root mean square error.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace a351::corrector {

/// Limits of a confidence interval, in the unit of the quantity.
struct Interval {
    double low = 0.0;
    double high = 0.0;
};

/// Number of bootstrap draws.  Reason: enough for the second digit of the limits.
inline constexpr int kBootstrapDraws = 1000;

/// Returns the 95 % bootstrap interval of the root mean square error sqrt(sum e^2 / n).
///
/// Each of kBootstrapDraws draws takes as many stations as there are, with replacement, and each
/// station with all its rows.  The limits are the 2.5 % and 97.5 % percentiles of the draws.
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

}  // namespace a351::corrector
