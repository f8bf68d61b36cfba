#pragma once
/// @file
/// The UART of the emulated sensor as a queue of frames.

#include <cstdint>

#include "protocol/core/utc_time.hpp"

namespace a351::sim {

/// Holds the frame on the line and one that waits; a frame that comes while both are taken is
/// dropped whole.  Below capacity nothing ever waits.  M-A352AD10 data sheet, rev. 20251023, 7.3:
/// UART_OVF says that frames come faster than the baud rate; which are lost it does not say.
class TransmitBuffer {
public:
    /// One period of the output rate goes by.
    void pass_period(int baud);

    /// @return  False: there is no room, the frame is dropped.
    [[nodiscard]] bool take(std::int64_t frame_bits, int rate_hz);

    /// How long a frame waits that comes after one more period.
    [[nodiscard]] Nanoseconds next_wait(int baud, int rate_hz) const;

    void clear() { backlog_ = 0; }

private:
    std::int64_t backlog_ = 0;  ///< Bits times rate in hertz: exact at any rate.
};

}  // namespace a351::sim
