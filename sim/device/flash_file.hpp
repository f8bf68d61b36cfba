#pragma once
/// @file
/// The flash memory of the emulated sensor as a TOML file, which keeps settings between runs:
///
///     format = 1
///     [registers]
///     SIG_CTRL = 0x8E04        # each register marked "Flash Backup", by its name
///     [user_filter]
///     bytes = ["0000002000000020 ..."]    # hexadecimal from address 0x0800 on; the rest is erased

#include <filesystem>

#include "protocol/wire/device_profile.hpp"
#include "sim/device/flash_memory.hpp"

namespace a351::sim {

/// Reads the file.
/// @return the factory state if the file does not exist.
/// @throws InputError  the file is damaged; names file, key and allowed values.
[[nodiscard]] FlashMemory read_flash_file(const std::filesystem::path& file,
                                          const wire::DeviceProfile& profile);

/// Replaces the whole file: at any instant it holds the old or the new content.
/// @throws std::system_error  the file cannot be replaced; names the path.
void write_flash_file(const std::filesystem::path& file, const FlashMemory& memory);

}  // namespace a351::sim
