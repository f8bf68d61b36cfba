#pragma once
/// @file
/// Real serial ports, by libserialport.  It knows neither pseudo-terminals nor links, leaves
/// XON/XOFF on, takes no lock and leaks descriptors to children: tty_port.cpp does all that.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/source/port.hpp"

namespace a351::daemon {

struct SerialPortEntry {
    std::filesystem::path path;
    std::filesystem::path by_id;  ///< Stable name below /dev/serial/by-id; empty when none.
    std::optional<UsbAddress> usb;
};

/// Ports that the kernel lists now, by path.
[[nodiscard]] std::vector<SerialPortEntry> list_serial_ports();

[[nodiscard]] std::optional<std::filesystem::path> find_usb_port(const UsbAddress& address);

/// Sets 8N1 at `baud` without flow control and verifies that the port keeps it.
/// @param device  a name in /dev, no link.
/// @throws PortError
void configure_serial_port(const std::filesystem::path& device, int baud);

}  // namespace a351::daemon
