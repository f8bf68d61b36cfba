#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "sim/truth/truth_file.hpp"

namespace a351::sim::device {

/// One moment on both clocks of the emulator.  Samples follow the scenario's clock.  Start-up and
/// answers follow the host's steady clock, because hosts wait in real time.
struct Instant {
    UtcTime simulated;
    Nanoseconds steady{0};
};

/// The device's end of the line.
class LineSink {
public:
    virtual ~LineSink() = default;

    /// Sends bytes without a pause; the last one leaves the device at `leaves`.
    /// @param frame  the frame's content; null for an answer to a command.
    virtual void send(std::span<const std::byte> bytes, UtcTime leaves,
                      const truth::Record* frame) = 0;

    /// Returns true if so many bytes wait to be read that the device should pause.  Sending more
    /// loses nothing but uses memory.
    [[nodiscard]] virtual bool is_full() const = 0;

    /// Takes back the bytes that the host has not seen yet.  A line without a buffer returns none.
    [[nodiscard]] virtual std::vector<std::byte> take_back() { return {}; }
};

/// A device that speaks the sensor's protocol at the far end of a line.  No I/O and no clock.
class LineDevice {
public:
    virtual ~LineDevice() = default;

    /// Takes bytes of commands from the host.
    virtual void receive(std::span<const std::byte> bytes, const Instant& now, LineSink& line) = 0;

    /// Sends the bytes that are due.  It may stop early, because the line is full or the call would
    /// take long; the rest stays due.
    virtual void advance_to(const Instant& now, LineSink& line) = 0;

    /// Returns when the next sample is due; std::nullopt after the last.
    [[nodiscard]] virtual std::optional<UtcTime> next_due() const = 0;

    /// Returns the present baud rate of its UART.
    [[nodiscard]] virtual int baud() const = 0;

    /// Returns true if it sends nothing while the host's terminal has another baud rate.  Bytes of
    /// other devices then arrive as other bytes.
    [[nodiscard]] virtual bool waits_for_baud() const { return false; }
};

}  // namespace a351::sim::device
