#pragma once

#include <span>
#include <string_view>

namespace a351::sim::scenario {

struct EmbeddedScenario {
    std::string_view name;
    std::string_view toml;
};

/// Returns the files of config/scenarios, which CMake compiles into the program.
[[nodiscard]] std::span<const EmbeddedScenario> embedded_scenarios() noexcept;

}  // namespace a351::sim::scenario
