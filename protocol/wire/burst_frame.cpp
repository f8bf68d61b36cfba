#include "protocol/wire/burst_frame.hpp"

#include <cassert>
#include <type_traits>

namespace a351::wire {
namespace {

template <class Integer>
void append_big_endian(Integer value, std::vector<std::byte>& out) {
    const auto bits = static_cast<std::make_unsigned_t<Integer>>(value);
    for (int shift = 8 * (static_cast<int>(sizeof(Integer)) - 1); shift >= 0; shift -= 8) {
        out.push_back(static_cast<std::byte>((bits >> shift) & 0xFFU));
    }
}

}  // namespace

std::uint16_t burst_checksum(std::span<const std::byte> payload) noexcept {
    assert(payload.size() % 2 == 0);
    unsigned sum = 0;
    for (std::size_t i = 0; i + 1 < payload.size(); i += 2) {
        sum += (std::to_integer<unsigned>(payload[i]) << 8U) +
               std::to_integer<unsigned>(payload[i + 1]);
    }
    return static_cast<std::uint16_t>(sum & 0xFFFFU);
}

void append_frame(const BurstLayout& layout, const BurstValues& values,
                  std::vector<std::byte>& out) {
    const std::size_t start = out.size();
    out.push_back(kStartByte);
    if (layout.has_flag()) append_big_endian(values.flag, out);
    if (layout.has_temperature()) append_big_endian(values.temperature, out);
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
        if (layout.has_axis(axis)) {
            append_big_endian(values.axes[static_cast<std::size_t>(axis)], out);
        }
    }
    if (layout.has_count()) append_big_endian(values.count, out);
    if (layout.has_checksum()) {
        append_big_endian(burst_checksum(std::span(out).subspan(start + 1)), out);
    }
    out.push_back(kEndByte);
}

}  // namespace a351::wire
