#pragma once
/// @file
/// A raw serial line: 8N1, no flow control, every byte value passes both ways.

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

namespace a351::daemon {

/// A USB adapter by what its maker burnt into it: survives another socket and another tty name.
struct UsbAddress {
    int vendor = 0;
    int product = 0;
    std::string serial;

    bool operator==(const UsbAddress&) const = default;
    [[nodiscard]] std::string to_text() const;  ///< VID:PID:SERIAL, hexadecimal.
};

/// Where the sensor is: exactly one of the two.
struct PortAddress {
    std::filesystem::path path;  ///< Device, pseudo-terminal, or a link to one.
    std::optional<UsbAddress> usb;

    [[nodiscard]] std::string to_text() const;
};

class Port {
public:
    virtual ~Port() = default;

    /// Waits until bytes are there, at most `timeout`.
    /// @return how many came, 0 after the time-out; std::nullopt: the port is gone for good
    ///         (end of stream, EIO, ENODEV and a hang-up alike).
    [[nodiscard]] virtual std::optional<std::size_t> read(std::span<std::byte> into,
                                                          std::chrono::milliseconds timeout) = 0;

    /// Hands over all bytes; false when the port is gone, or took nothing for a second.
    [[nodiscard]] virtual bool write(std::span<const std::byte> bytes) = 0;

    /// Path, speed, and what is known of its latency, in one line.
    [[nodiscard]] virtual const std::string& description() const noexcept = 0;
};

/// Why a port could not be opened.
class PortError : public std::runtime_error {
public:
    enum class Kind {
        absent,   ///< Nothing there, or nothing that answers: try again later.
        locked,   ///< Another process holds it.
        settings  ///< It does not accept, or does not keep, the settings that we need.
    };
    PortError(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
    [[nodiscard]] Kind kind() const noexcept { return kind_; }

private:
    Kind kind_;
};

/// Locks, opens and sets up a port.  Links are resolved anew on every call.
/// @throws PortError
[[nodiscard]] std::unique_ptr<Port> open_port(const PortAddress& address, int baud);

}  // namespace a351::daemon
