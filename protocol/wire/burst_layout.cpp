#include "protocol/wire/burst_layout.hpp"

namespace a351::wire {
namespace {

constexpr std::uint16_t kAxesOut = kXOut | kYOut | kZOut;
constexpr std::uint16_t kDefinedBits =
    kFlagOut | kTemperatureOut | kAxesOut | kCountOut | kChecksumOut;

}  // namespace

std::optional<BurstLayout> BurstLayout::from_burst_ctrl(std::uint16_t value) noexcept {
    if ((value & ~kDefinedBits) != 0 || (value & kAxesOut) == 0) return std::nullopt;
    return BurstLayout(value);
}

BurstLayout BurstLayout::recommended() noexcept { return BurstLayout(kDefinedBits); }

std::size_t BurstLayout::frame_size() const noexcept {
    std::size_t size = 2;  // start and end byte
    if (has_flag()) size += 2;
    if (has_temperature()) size += 4;
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
        if (has_axis(axis)) size += 4;
    }
    if (has_count()) size += 2;
    if (has_checksum()) size += 2;
    return size;
}

}  // namespace a351::wire
