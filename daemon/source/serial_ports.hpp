#pragma once
/// @file
/// Real serial ports with libserialport.  The library does not support pseudo-terminals or
/// links, leaves XON/XOFF on, takes no lock and passes descriptors to children.  tty_port.cpp
/// handles all of these.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/source/port.hpp"

namespace a351::daemon {

struct SerialPortEntry {
    std::filesystem::path path;
    std::filesystem::path by_id;  ///< Stable name below /dev/serial/by-id; empty if none.
    std::optional<UsbAddress> usb;
};

/// Lists the ports that the kernel knows now, sorted by path.
[[nodiscard]] std::vector<SerialPortEntry> list_serial_ports();

/// Returns the path of the port with this address; std::nullopt if it is not plugged in.
[[nodiscard]] std::optional<std::filesystem::path> find_usb_port(const UsbAddress& address);

/// Sets 8N1 at `baud` without flow control and verifies that the port keeps it.
/// @param device  a name in /dev, not a link.
/// @throws PortError
void configure_serial_port(const std::filesystem::path& device, int baud);

}  // namespace a351::daemon
