#pragma once
/// @file
/// TOML -> DeviceProfile.  Keys and limits: profile-format.md.

#include <filesystem>
#include <string>
#include <string_view>

#include "protocol/wire/device_profile.hpp"

namespace a351::wire {

/// Returns the profile that a text describes.
/// @param name    name of the profile; kept as it is.
/// @param origin  file name shown in messages.
/// @throws InputError  the text breaks the format; names line, key, value and what is allowed.
[[nodiscard]] DeviceProfile parse_profile(std::string_view toml, std::string name,
                                          const std::filesystem::path& origin);

}  // namespace a351::wire
