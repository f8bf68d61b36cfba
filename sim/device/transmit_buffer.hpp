#pragma once
/// @file
/// The UART of the emulated sensor as a queue of frames.

#include <cstdint>

#include "protocol/core/utc_time.hpp"

namespace a351::sim {

/// Holds the frame on the line and one that waits.  A frame that comes while both places are taken
/// is dropped whole.  If the baud rate suffices, no frame waits.  M-A352AD10 data sheet, rev.
/// 20251023, 7.3: UART_OVF means that frames come faster than the baud rate allows; the data sheet
/// does not say which frames are lost.
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

}  // namespace a351::sim
