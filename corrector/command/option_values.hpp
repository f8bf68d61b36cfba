#pragma once

#include <string>
#include <string_view>

#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

/// The instant written in an option.
/// @throws InputError  it is not RFC 3339.
[[nodiscard]] UtcTime instant_option(std::string_view name, const std::string& text);

/// The value itself.
/// @throws InputError  outside [low, high], or not a number.
double number_option(std::string_view name, double value, double low, double high);

/// Largest ensemble that a command accepts: a day of computing for a day of data.
inline constexpr int kMostMembers = 1'000'000;

/// Gravimetric factors between which an Earth could be.
inline constexpr double kLeastFactor = 0.5;
inline constexpr double kGreatestFactor = 2.0;

}  // namespace a351::corrector
