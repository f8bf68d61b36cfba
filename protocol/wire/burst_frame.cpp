#include "protocol/wire/burst_frame.hpp"

#include <cassert>
#include <type_traits>

namespace a351::wire {
namespace {

constexpr std::uint16_t kAxesOut = kXOut | kYOut | kZOut;
constexpr std::uint16_t kDefinedBits =
    kFlagOut | kTemperatureOut | kAxesOut | kCountOut | kChecksumOut;

template <class Integer>
void append_big_endian(Integer value, std::vector<std::byte>& out) {
    const auto bits = static_cast<std::make_unsigned_t<Integer>>(value);
    for (int shift = 8 * (static_cast<int>(sizeof(Integer)) - 1); shift >= 0; shift -= 8)
        out.push_back(static_cast<std::byte>((bits >> shift) & 0xFFU));
}

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

std::uint16_t burst_checksum(std::span<const std::byte> payload) noexcept {
    assert(payload.size() % 2 == 0);
    unsigned sum = 0;
    for (std::size_t i = 0; i + 1 < payload.size(); i += 2) sum += word_at(payload, i);
    return static_cast<std::uint16_t>(sum & 0xFFFFU);
}

void append_frame(const BurstLayout& layout, const BurstValues& values,
                  std::vector<std::byte>& out) {
    const std::size_t start = out.size();
    out.push_back(kStartByte);
    if (layout.has_flag()) append_big_endian(values.flag, out);
    if (layout.has_temperature()) append_big_endian(values.temperature, out);
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
        if (layout.has_axis(axis))
            append_big_endian(values.axes[static_cast<std::size_t>(axis)], out);
    }
    if (layout.has_count()) append_big_endian(values.count, out);
    if (layout.has_checksum())
        append_big_endian(burst_checksum(std::span(out).subspan(start + 1)), out);
    out.push_back(kEndByte);
}

}  // namespace a351::wire
