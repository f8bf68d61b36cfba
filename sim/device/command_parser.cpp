#include "sim/device/command_parser.hpp"

namespace a351::sim {
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

}  // namespace a351::sim
