#include "sim/device/transmit_buffer.hpp"

#include <algorithm>

namespace a351::sim {

void TransmitBuffer::pass_period(int baud) {
    backlog_ = std::max<std::int64_t>(0, backlog_ - baud);
}

bool TransmitBuffer::take(std::int64_t frame_bits, int rate_hz) {
    const std::int64_t cost = frame_bits * rate_hz;
    if (backlog_ > cost) return false;
    backlog_ += cost;
    return true;
}

Nanoseconds TransmitBuffer::next_wait(int baud, int rate_hz) const {
    constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
    const std::int64_t waiting = std::max<std::int64_t>(0, backlog_ - baud);
    return Nanoseconds(waiting * kNanosecondsPerSecond / (std::int64_t{rate_hz} * baud));
}

}  // namespace a351::sim
