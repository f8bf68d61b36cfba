#pragma once

#include <span>
#include <string_view>

namespace a351::wire {

struct ShippedProfile {
    std::string_view name;
    std::string_view toml;
};

/// Returns the files of config/profiles, which CMake compiles into the program.
[[nodiscard]] std::span<const ShippedProfile> shipped_profiles() noexcept;

}  // namespace a351::wire
