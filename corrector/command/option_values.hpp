#pragma once

#include <string>
#include <string_view>

#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

/// Returns the instant given in an option.
/// @throws InputError  it is not RFC 3339.
[[nodiscard]] UtcTime instant_option(std::string_view name, const std::string& text);

/// Returns the value.
/// @throws InputError  it is outside [low, high], or NaN.
double number_option(std::string_view name, double value, double low, double high);

/// Largest ensemble that a command accepts: a day of computing for a day of data.
inline constexpr int kMostMembers = 1'000'000;

/// Range of gravimetric factors that is accepted; 1 is a rigid Earth.
inline constexpr double kLeastFactor = 0.5;
inline constexpr double kGreatestFactor = 2.0;

}  // namespace a351::corrector
