#pragma once
/// @file
/// The UART of the emulated sensor: the parser of the host's commands, and the queue of frames.
/// M-A352AD10 data sheet, rev. 20251023, 6.2.1-6.2.3, 7.3.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/core/utc_time.hpp"

namespace a351::sim::device {

struct HostCommand {
    std::uint8_t address = 0;  ///< Bit 7: a write.
    std::uint8_t value = 0;
};

/// Every command is address, value, CR.  The data sheet does not define damaged commands.  The
/// rules here let a lone CR, as hosts send it, end a partial command:
/// - A CR at the start of a command is skipped.
/// - If the third byte is not CR, the first byte is dropped and the rest is parsed again.
/// - A partial command is forgotten after kPartialCommandLife.
class CommandParser {
public:
    static constexpr std::chrono::milliseconds kPartialCommandLife{100};  ///< Assumed.

    /// Takes a byte.  @return the command that `byte` completes, if any.
    [[nodiscard]] std::optional<HostCommand> next(std::byte byte, Nanoseconds now);

    void forget() { partial_.clear(); }

private:
    std::vector<std::byte> partial_;
    Nanoseconds since_{0};  ///< Arrival of its first byte.
};

/// Holds the frame on the line and one that waits.  A frame that comes while both places are taken
/// is dropped whole.  If the baud rate suffices, no frame waits.  UART_OVF means that frames come
/// faster than the baud rate allows (7.3); the data sheet does not say which frames are lost.
class TransmitBuffer {
public:
    /// Passes one period of the output rate.
    void pass_period(int baud);

    /// Takes a frame.  @return false if there is no room: the frame is dropped.
    [[nodiscard]] bool take(std::int64_t frame_bits, int rate_hz);

    /// Returns how long a frame that comes after one more period has to wait.
    [[nodiscard]] Nanoseconds next_wait(int baud, int rate_hz) const;

    void clear() { backlog_ = 0; }

private:
    std::int64_t backlog_ = 0;  ///< Bits times output rate in Hz: an integer at any rate.
};

}  // namespace a351::sim::device
