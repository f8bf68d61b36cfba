#pragma once
/// @file
/// Memory that the emulated sensor keeps without power: the registers marked "Flash Backup" in
/// table 7.1 of the M-A352AD10 data sheet (rev. 20251023) and the coefficients of the user filter
/// (5.17.2).  As a TOML file it keeps settings between runs:
///
///     format = 1
///     [registers]
///     SIG_CTRL = 0x8E04        # each register marked "Flash Backup", by its name
///     [user_filter]
///     bytes = ["0000002000000020 ..."]    # hexadecimal from address 0x0800 on; the rest is erased

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>

#include "protocol/wire/device_profile.hpp"
#include "protocol/wire/registers.hpp"

namespace a351::sim::device {

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

/// Reads the file.
/// @return the factory state if the file does not exist.
/// @throws InputError  the file is damaged; names file, key and allowed values.
[[nodiscard]] FlashMemory read_flash_file(const std::filesystem::path& file,
                                          const wire::DeviceProfile& profile);

/// Replaces the whole file: at any instant it holds the old or the new content.
/// @throws std::system_error  the file cannot be replaced; names the path.
void write_flash_file(const std::filesystem::path& file, const FlashMemory& memory);

}  // namespace a351::sim::device
