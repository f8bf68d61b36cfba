#include "sim/device/signal_path.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace a351::sim::device {
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
        for (std::size_t i = kBytesPerCoefficient; i-- > 0;)
            bits = (bits << 8U) | coefficients[tap * kBytesPerCoefficient + i];
        sum += static_cast<std::int32_t>(bits);
    }
    return std::ldexp(static_cast<double>(sum), -kFractionBits);
}

LongTermFilter::MovingAverage::MovingAverage(int log2_taps)
    : newest_(std::size_t{1} << log2_taps), log2_taps_(log2_taps) {}

std::int32_t LongTermFilter::MovingAverage::next(std::int32_t value) {
    sum_ += std::int64_t{value} - newest_[oldest_];
    newest_[oldest_] = value;
    oldest_ = (oldest_ + 1) % newest_.size();
    return static_cast<std::int32_t>(sum_ >> log2_taps_);
}

void LongTermFilter::start(Kind kind, int log2_taps) {
    assert(log2_taps >= 1 && log2_taps <= 12);
    kind_ = kind;
    averages_.clear();
    if (kind == Kind::off) return;
    averages_.assign(kind == Kind::low_pass ? 6 : 3, MovingAverage(log2_taps));
}

std::array<std::int32_t, 3> LongTermFilter::next(const std::array<std::int32_t, 3>& axes_counts) {
    std::array<std::int32_t, 3> filtered = axes_counts;
    if (kind_ == Kind::off) return filtered;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int32_t average = averages_[axis].next(axes_counts[axis]);
        if (kind_ == Kind::low_pass) {
            filtered[axis] = averages_[3 + axis].next(average);
        } else {
            using Limits = std::numeric_limits<std::int32_t>;
            filtered[axis] = static_cast<std::int32_t>(std::clamp<std::int64_t>(
                std::int64_t{axes_counts[axis]} - average, Limits::min(), Limits::max()));
        }
    }
    return filtered;
}

LimitedAxis limited_axis(std::int32_t counts, const AxisSettings& settings,
                         const wire::DeviceProfile& profile) noexcept {
    const std::int64_t one_g = std::int64_t{1} << profile.acceleration_fraction_bits;
    const std::int64_t upper = settings.upper_limit_g * one_g;
    const std::int64_t lower = settings.lower_limit_g * one_g;
    const std::int64_t sum = std::int64_t{counts} + settings.offset_counts;
    // Not std::clamp: the host may set the lower limit above the upper.
    return {static_cast<std::int32_t>(std::min(std::max(sum, lower), upper)),
            sum > upper || sum < lower};
}

std::int32_t tilt_counts(std::int32_t acceleration_counts,
                         const wire::DeviceProfile& profile) noexcept {
    const double sine = std::clamp(profile.acceleration(acceleration_counts).value(), -1.0, 1.0);
    const double counts = std::round(std::ldexp(std::asin(sine), profile.tilt_fraction_bits));
    return std::clamp(static_cast<std::int32_t>(counts), -kLargestTiltCounts, kLargestTiltCounts);
}

}  // namespace a351::sim::device
