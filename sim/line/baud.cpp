#include "sim/line/baud.hpp"

#include <cmath>

namespace a351::sim {
namespace {

constexpr double kBitsPerByte = 10.0;  ///< Start bit, eight bits from the lowest on, stop bit.

/// Returns the level of the line; the time is in bits of the sender.  The idle line is high.
bool level(std::span<const std::byte> bytes, double bit) {
    const auto index = static_cast<std::size_t>(bit / kBitsPerByte);
    if (bit < 0.0 || index >= bytes.size()) return true;
    const int within = static_cast<int>(bit) - 10 * static_cast<int>(index);
    if (within == 0) return false;
    if (within == 9) return true;
    return ((std::to_integer<unsigned>(bytes[index]) >> (within - 1)) & 1U) != 0;
}

}  // namespace

std::vector<std::byte> received_at_baud(std::span<const std::byte> bytes, int sent_baud,
                                        int heard_baud) {
    // In bits of the sender: length of a receiver's bit, end of the bytes, present position, which
    // is the start of a bit or the end of a stop bit within it.
    const double ratio = static_cast<double>(sent_baud) / heard_baud;
    const double end = kBitsPerByte * static_cast<double>(bytes.size());
    std::vector<std::byte> heard;
    double at = 0.0;
    while (at < end) {
        if (level(bytes, at)) {
            at = std::floor(at) + 1.0;
            continue;
        }
        unsigned value = 0;
        for (int bit = 0; bit < 8; ++bit) {
            if (level(bytes, at + (bit + 1.5) * ratio)) value |= 1U << bit;
        }
        heard.push_back(static_cast<std::byte>(value));
        at += 9.5 * ratio;
    }
    return heard;
}

}  // namespace a351::sim
