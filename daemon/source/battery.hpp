#pragma once

#include <filesystem>
#include <optional>

namespace a351::daemon::source {

/// The batteries of this computer, as the kernel reports them.
struct Battery {
    double percent = 0.0;         ///< Charge; of several batteries the mean.
    bool is_discharging = false;  ///< At least one of them.
};

/// Returns the state of the batteries; std::nullopt if there is none.  The battery of a mouse or
/// another device does not count.
/// @param supplies  directory of the kernel with a folder for each power supply.
[[nodiscard]] std::optional<Battery> read_battery(
    const std::filesystem::path& supplies = "/sys/class/power_supply");

}  // namespace a351::daemon::source
