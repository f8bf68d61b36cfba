#pragma once
/// @file
/// The flash memory of the emulated sensor as a TOML file, so that settings outlive the program:
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

/// @return factory state when there is no such file.
/// @throws InputError  the file is damaged: names file, key and what is allowed.
[[nodiscard]] FlashMemory read_flash_file(const std::filesystem::path& file,
                                          const wire::DeviceProfile& profile);

/// Replaces the file as a whole: at any instant it holds the old content or the new.
/// @throws std::system_error  with the path.
void write_flash_file(const std::filesystem::path& file, const FlashMemory& memory);

}  // namespace a351::sim
