#include "sim/device/user_filter.hpp"

#include <cassert>
#include <cmath>

namespace a351::sim {
namespace {

constexpr std::uint8_t kReadCommand = 1;
constexpr std::uint8_t kWriteCommand = 2;
constexpr std::uint16_t kDataError = 0x8000;
constexpr int kFractionBits = 31;
constexpr std::size_t kBytesPerCoefficient = 4;

}  // namespace

void UserFilter::start(std::uint8_t command, Nanoseconds now) {
    if (command_ != 0 || (command != kReadCommand && command != kWriteCommand)) return;
    command_ = command;
    ends_at_ = now + (command == kReadCommand ? Nanoseconds(kReadTime) : Nanoseconds(kWriteTime));
}

void UserFilter::set_data(std::uint8_t byte) {
    if (command_ == 0) data_ = byte;
}

void UserFilter::set_address(std::uint16_t address) {
    assert(address >= kFirstAddress && address <= kLastAddress);
    if (command_ == 0) address_ = address;
}

void UserFilter::end_due(Nanoseconds now, std::span<std::uint8_t> coefficients, bool is_readable) {
    if (command_ == 0 || now < ends_at_) return;
    std::uint8_t& byte = coefficients[static_cast<std::size_t>(address_ - kFirstAddress)];
    if (command_ == kWriteCommand) {
        byte = static_cast<std::uint8_t>(data_ & 0xFFU);
    } else {
        data_ = is_readable ? byte : kDataError;
    }
    address_ = address_ == kLastAddress ? kFirstAddress : static_cast<std::uint16_t>(address_ + 1);
    command_ = 0;
}

double constant_gain(std::span<const std::uint8_t> coefficients, int taps) {
    assert(static_cast<std::size_t>(taps) * kBytesPerCoefficient <= coefficients.size());
    std::int64_t sum = 0;
    for (std::size_t tap = 0; tap < static_cast<std::size_t>(taps); ++tap) {
        std::uint32_t bits = 0;
        for (std::size_t i = kBytesPerCoefficient; i-- > 0;) {
            bits = (bits << 8U) | coefficients[tap * kBytesPerCoefficient + i];
        }
        sum += static_cast<std::int32_t>(bits);
    }
    return std::ldexp(static_cast<double>(sum), -kFractionBits);
}

}  // namespace a351::sim
