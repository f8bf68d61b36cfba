#pragma once

#include <span>
#include <string_view>

namespace a351::sim {

struct EmbeddedScenario {
    std::string_view name;
    std::string_view toml;
};

/// The files of config/scenarios, written into the program by CMake.
[[nodiscard]] std::span<const EmbeddedScenario> embedded_scenarios() noexcept;

}  // namespace a351::sim
