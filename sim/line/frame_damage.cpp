#include "sim/line/frame_damage.hpp"

#include <algorithm>
#include <cassert>

#include "protocol/wire/burst_frame.hpp"

namespace a351::sim::line {
namespace {

constexpr std::size_t kTail = 3;  ///< Checksum and end marker.

/// Returns a number from 0 to count - 1.
std::size_t draw(std::size_t count, noise::RandomStream& random) {
    return static_cast<std::size_t>(random.bits() % count);
}

/// Returns true if `bytes` contain a whole frame of `size` bytes, judged by its markers and, with
/// `has_checksum`, its checksum.
bool holds_frame(std::span<const std::byte> bytes, std::size_t size, bool has_checksum) {
    for (std::size_t at = 0; at + size <= bytes.size(); ++at) {
        const auto frame = bytes.subspan(at, size);
        if (frame.front() != wire::kStartByte || frame.back() != wire::kEndByte) continue;
        if (!has_checksum || has_right_checksum(frame)) return true;
    }
    return false;
}

Bytes drawn(int count, bool has_markers, noise::RandomStream& random) {
    Bytes bytes(static_cast<std::size_t>(count));
    for (std::byte& byte : bytes) {
        do {
            byte = static_cast<std::byte>(random.bits() >> 56U);
        } while (!has_markers && (byte == wire::kStartByte || byte == wire::kEndByte));
    }
    return bytes;
}

Bytes joined(std::span<const std::byte> frame, std::size_t at, std::span<const std::byte> more) {
    Bytes bytes(frame.begin(), frame.end());
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), more.begin(), more.end());
    return bytes;
}

}  // namespace

bool has_right_checksum(std::span<const std::byte> frame) {
    if (frame.size() < kTail + 3) return false;
    const std::size_t at = frame.size() - kTail;
    return wire::word_at(frame, at) == wire::burst_checksum(frame.subspan(1, at - 1));
}

Bytes with_flipped_bits(std::span<const std::byte> frame, int bits, noise::RandomStream& random) {
    Bytes bytes(frame.begin(), frame.end());
    const std::size_t words = (frame.size() - 2) / 2;
    const std::size_t place = draw(words + 2, random);  // The last two are the markers.
    const bool is_marker = place >= words;
    const std::size_t first = !is_marker ? 1 + 2 * place : place == words ? 0 : frame.size() - 1;
    const std::size_t width = is_marker ? 8 : 16;
    for (std::size_t left = std::min(static_cast<std::size_t>(bits), width), flipped = 0;
         left > 0;) {
        const std::size_t bit = draw(width, random);
        if ((flipped >> bit & 1U) != 0) continue;
        flipped |= std::size_t{1} << bit;
        bytes[first + bit / 8] ^= std::byte{1} << (bit % 8);
        --left;
    }
    return bytes;
}

Bytes with_bad_checksum(std::span<const std::byte> frame, noise::RandomStream& random) {
    assert(has_right_checksum(frame));
    Bytes bytes(frame.begin(), frame.end());
    const std::size_t change = 1 + draw(0xFFFF, random);
    bytes[frame.size() - kTail] ^= static_cast<std::byte>(change >> 8U);
    bytes[frame.size() - kTail + 1] ^= static_cast<std::byte>(change & 0xFFU);
    return bytes;
}

Bytes without_bytes(std::span<const std::byte> frame, int count, noise::RandomStream& random) {
    const std::size_t dropped = std::min(static_cast<std::size_t>(count), frame.size() - 1);
    const std::size_t at = draw(frame.size() - dropped + 1, random);
    Bytes bytes(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(at));
    bytes.insert(bytes.end(), frame.begin() + static_cast<std::ptrdiff_t>(at + dropped),
                 frame.end());
    return bytes;
}

Bytes with_more_bytes(std::span<const std::byte> frame, int count, noise::RandomStream& random) {
    const bool has_checksum = has_right_checksum(frame);
    const std::size_t places = frame.size() - 1;
    const std::size_t first = draw(places, random);
    Bytes bytes;
    for (std::size_t i = 0; i < places; ++i) {
        const std::size_t at = 1 + (first + i) % places;
        bytes = joined(frame, at, drawn(count, has_checksum, random));
        if (!holds_frame(bytes, frame.size(), has_checksum)) break;
    }
    return bytes;
}

Bytes cut_short(std::span<const std::byte> frame, noise::RandomStream& random) {
    const std::size_t kept = 1 + draw(frame.size() - 1, random);
    return {frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(kept)};
}

Bytes garbage_before(std::span<const std::byte> frame, int count, noise::RandomStream& random) {
    return drawn(count, has_right_checksum(frame), random);
}

Bytes cut_by_answer(std::span<const std::byte> frame, std::span<const std::byte> answer,
                    noise::RandomStream& random) {
    return joined(frame, 1 + draw(frame.size() - 1, random), answer);
}

}  // namespace a351::sim::line
