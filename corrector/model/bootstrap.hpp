#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace a351::corrector {

struct Interval {
    double low = 0.0;
    double high = 0.0;
};

/// Enough for the second digit of the limits.
inline constexpr int kBootstrapDraws = 1000;

/// 95 % interval of sqrt(mean of squares) when stations are drawn anew with replacement, each with
/// all its rows: 2.5 % and 97.5 % of kBootstrapDraws.  The same seed gives the same on any machine.
/// @param stations  one per error.
/// @return std::nullopt for fewer than two stations.
[[nodiscard]] std::optional<Interval> bootstrap_rms_interval(
    const std::vector<double>& errors, const std::vector<std::string>& stations,
    std::uint64_t seed);

}  // namespace a351::corrector
