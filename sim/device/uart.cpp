#include "sim/device/uart.hpp"

#include <algorithm>

namespace a351::sim::device {
namespace {

constexpr std::byte kCarriageReturn{0x0D};
constexpr std::size_t kCommandSize = 3;

}  // namespace

std::optional<HostCommand> CommandParser::next(std::byte byte, Nanoseconds now) {
    if (!partial_.empty() && now - since_ > kPartialCommandLife) partial_.clear();
    if (partial_.empty() && byte == kCarriageReturn) return std::nullopt;
    if (partial_.empty()) since_ = now;
    partial_.push_back(byte);
    if (partial_.size() < kCommandSize) return std::nullopt;
    if (partial_.back() == kCarriageReturn) {
        const HostCommand command{std::to_integer<std::uint8_t>(partial_[0]),
                                  std::to_integer<std::uint8_t>(partial_[1])};
        partial_.clear();
        return command;
    }
    partial_.erase(partial_.begin());
    if (partial_.front() == kCarriageReturn) partial_.erase(partial_.begin());
    return std::nullopt;
}

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

}  // namespace a351::sim::device
