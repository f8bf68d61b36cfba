#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "protocol/core/utc_time.hpp"
#include "sim/truth/truth_file.hpp"

namespace a351::sim {

/// One moment on both of the emulator's clocks: the scenario's, on which samples are taken, and the
/// host's steady clock, on which the device boots and answers, as hosts wait in real time.
struct Instant {
    UtcTime simulated;
    Nanoseconds steady{0};
};

/// The device's end of the line.
class LineSink {
public:
    virtual ~LineSink() = default;

    /// Bytes that the device sends in one go; the last of them leaves it at `leaves`.  `frame`: what
    /// they stand for; null for an answer to a command.
    virtual void send(std::span<const std::byte> bytes, UtcTime leaves,
                      const TruthRecord* frame) = 0;

    /// So much waits to be read that the device had better pause: nothing is lost by sending, but
    /// memory grows.
    [[nodiscard]] virtual bool is_full() const = 0;
};

/// Anything that speaks the sensor's protocol at the far end of a line.  No I/O and no clock.
class LineDevice {
public:
    virtual ~LineDevice() = default;

    /// Commands from the host.
    virtual void receive(std::span<const std::byte> bytes, const Instant& now, LineSink& line) = 0;

    /// Sends what is due, as long as the line is not full and it takes no time to speak of: what is
    /// left stays due.
    virtual void advance_to(const Instant& now, LineSink& line) = 0;

    /// When the next sample falls due; std::nullopt after the last.
    [[nodiscard]] virtual std::optional<UtcTime> next_due() const = 0;

    /// Of its UART, at this moment.
    [[nodiscard]] virtual int baud() const = 0;
};

}  // namespace a351::sim
