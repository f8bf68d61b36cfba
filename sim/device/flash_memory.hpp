#pragma once
/// @file
/// Memory that the emulated sensor keeps without power: the registers marked "Flash Backup" in
/// table 7.1 of the M-A352AD10 data sheet (rev. 20251023) and the coefficients of the user filter
/// (5.17.2).

#include <algorithm>
#include <array>
#include <cstdint>

#include "protocol/wire/registers.hpp"

namespace a351::sim {

struct FlashMemory {
    static constexpr auto kSavedCount = static_cast<std::size_t>(
        std::ranges::count(wire::kRegisters, true, &wire::Register::is_saved_in_flash));
    static constexpr std::size_t kCoefficientBytes = 2048;  ///< 512 taps (table 5.2).
    static constexpr std::uint8_t kErased = 0xFF;  ///< Erased; "No specific values" (5.17.2).

    /// Values of the saved registers in the order of wire::kRegisters.
    using Settings = std::array<std::uint16_t, kSavedCount>;
    using Coefficients = std::array<std::uint8_t, kCoefficientBytes>;

    [[nodiscard]] static constexpr Settings factory_settings() noexcept {
        Settings settings{};
        std::size_t i = 0;
        for (const wire::Register& reg : wire::kRegisters) {
            if (reg.is_saved_in_flash) settings[i++] = reg.default_value;
        }
        return settings;
    }

    [[nodiscard]] static constexpr Coefficients erased() noexcept {
        Coefficients bytes{};
        bytes.fill(kErased);
        return bytes;
    }

    Settings settings = factory_settings();
    Coefficients coefficients = erased();

    bool operator==(const FlashMemory&) const = default;
};

}  // namespace a351::sim
