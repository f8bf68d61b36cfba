#pragma once
/// @file
/// A raw serial line: 8N1, no flow control, every byte value passes in both directions.
///
/// Real serial ports are listed and set up with libserialport.  The library does not support
/// pseudo-terminals or links, leaves XON/XOFF on, takes no lock and passes descriptors to children.
/// tty_port.cpp handles all of these.

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace a351::daemon::source {

/// A USB adapter by the identifiers that its maker stored in it.  They stay the same in another USB
/// socket and under another tty name.
struct UsbAddress {
    int vendor = 0;
    int product = 0;
    std::string serial;

    bool operator==(const UsbAddress&) const = default;
    [[nodiscard]] std::string to_text() const;  ///< VID:PID:SERIAL, hexadecimal.
};

/// Address of the sensor's port: exactly one of the two is set.
struct PortAddress {
    std::filesystem::path path;  ///< Device, pseudo-terminal, or a link to one.
    std::optional<UsbAddress> usb;

    [[nodiscard]] std::string to_text() const;
};

class Port {
public:
    virtual ~Port() = default;

    /// Waits for bytes, at most `timeout`.
    /// @return number of bytes read, 0 after the time-out; std::nullopt if the port is gone (end of
    ///         stream, EIO, ENODEV or a hang-up).
    [[nodiscard]] virtual std::optional<std::size_t> read(std::span<std::byte> into,
                                                          std::chrono::milliseconds timeout) = 0;

    /// Writes all bytes.  @return false if the port is gone, or accepted nothing for a second.
    [[nodiscard]] virtual bool write(std::span<const std::byte> bytes) = 0;

    /// Returns path, speed and latency settings, as far as known, in one line.
    [[nodiscard]] virtual const std::string& description() const noexcept = 0;
};

/// The reason why a port could not be opened.
class PortError : public std::runtime_error {
public:
    enum class Kind {
        absent,   ///< The port does not exist or cannot be opened now: try again later.
        locked,   ///< Another process holds it.
        settings  ///< The port does not accept or does not keep the required settings.
    };
    /// @param port  path or address, for the message `port: trouble`.
    PortError(Kind kind, const std::string& port, const std::string& trouble)
        : std::runtime_error(port + ": " + trouble), kind_(kind) {}
    [[nodiscard]] Kind kind() const noexcept { return kind_; }

private:
    Kind kind_;
};

/// Locks, opens and sets up a port.  Links are resolved again on every call.
/// @throws PortError
[[nodiscard]] std::unique_ptr<Port> open_port(const PortAddress& address, int baud);

struct SerialPortEntry {
    std::filesystem::path path;
    std::filesystem::path by_id;  ///< Stable name below /dev/serial/by-id; empty if none.
    std::optional<UsbAddress> usb;
};

/// Lists the ports that the kernel knows now, sorted by path.
[[nodiscard]] std::vector<SerialPortEntry> list_serial_ports();

/// Returns the ports as lines for people, and marks those of FTDI: the sensor's adapter is one of them.
[[nodiscard]] std::string port_table(const std::vector<SerialPortEntry>& ports);

/// Sets 8N1 at `baud` without flow control and verifies that the port keeps it.
/// @param device  a name in /dev, not a link.
/// @throws PortError
void configure_serial_port(const std::filesystem::path& device, int baud);

}  // namespace a351::daemon::source
