#pragma once
/// @file
/// Streams of burst frames, intact and damaged, and the events that the decoder makes of them.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <ostream>
#include <random>
#include <span>
#include <variant>
#include <vector>

#include "protocol/wire/burst_decoder.hpp"

namespace a351::wire {

using Bytes = std::vector<std::byte>;

inline Bytes to_bytes(std::initializer_list<int> values) {
    Bytes bytes;
    for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
    return bytes;
}

inline Bytes joined(std::initializer_list<Bytes> parts) {
    Bytes all;
    for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

inline BurstLayout layout_of(int burst_ctrl) {
    return BurstLayout::from_burst_ctrl(static_cast<std::uint16_t>(burst_ctrl)).value();
}

inline constexpr std::uint16_t kStep = 80;  // 50 Hz

/// Returns the values of a healthy device at rest in its i-th frame, without the fields that
/// `layout` lacks.
inline BurstValues values_at(const BurstLayout& layout, unsigned i) {
    const auto drift = static_cast<std::int32_t>(i);
    BurstValues values{};
    if (layout.has_flag()) values.flag = 0x8E00;
    if (layout.has_temperature()) values.temperature = -1981 - drift;
    if (layout.has_axis(Axis::x)) values.axes[0] = -203896 + 7 * drift;
    if (layout.has_axis(Axis::y)) values.axes[1] = 604794 - 3 * drift;
    if (layout.has_axis(Axis::z)) values.axes[2] = 16713252 + 11 * drift;
    if (layout.has_count()) values.count = static_cast<std::uint16_t>(kStep * (i + 1));
    return values;
}

inline Bytes frame_at(const BurstLayout& layout, unsigned i) {
    Bytes bytes;
    append_frame(layout, values_at(layout, i), bytes);
    return bytes;
}

inline Bytes frames(const BurstLayout& layout, unsigned first, unsigned count) {
    Bytes bytes;
    for (unsigned i = first; i < first + count; ++i) {
        append_frame(layout, values_at(layout, i), bytes);
    }
    return bytes;
}

/// An event that can be compared: a frame, or a run of `discarded` bytes.
struct Event {
    BurstValues values{};
    Discarded::Reason reason = Discarded::Reason::no_start_byte;
    std::size_t discarded = 0;

    bool operator==(const Event&) const = default;
    [[nodiscard]] bool is_frame() const { return discarded == 0; }
};

inline std::ostream& operator<<(std::ostream& out, const Event& event) {
    if (event.is_frame()) return out << "frame(count " << event.values.count << ")";
    return out << "discarded(" << event.discarded << ", reason " << static_cast<int>(event.reason)
               << ")";
}

inline void feed(BurstDecoder& decoder, std::span<const std::byte> input,
                 std::vector<Event>& events) {
    while (const auto event = decoder.next(input)) {
        if (const auto* frame = std::get_if<BurstFrame>(&*event)) {
            events.push_back({.values = frame->values()});
        } else {
            const auto& run = std::get<Discarded>(*event);
            events.push_back({.reason = run.reason, .discarded = run.byte_count});
        }
    }
}

inline std::vector<Event> decode(const BurstLayout& layout, const Bytes& stream) {
    BurstDecoder decoder(layout, kStep);
    std::vector<Event> events;
    feed(decoder, stream, events);
    return events;
}

inline std::vector<BurstValues> frames_in(const std::vector<Event>& events) {
    std::vector<BurstValues> found;
    for (const Event& event : events) {
        if (event.is_frame()) found.push_back(event.values);
    }
    return found;
}

/// Returns the values of frames `first` ... `first + count - 1` without frame `lost`.
inline std::vector<BurstValues> values_except(const BurstLayout& layout, unsigned first,
                                              unsigned count, unsigned lost) {
    std::vector<BurstValues> values;
    for (unsigned i = first; i < first + count; ++i) {
        if (i != lost) values.push_back(values_at(layout, i));
    }
    return values;
}

/// Returns random bytes, or bytes rich in frame markers; the same for a seed on any machine.
inline Bytes garbage(std::uint64_t seed, std::size_t size, bool is_rich_in_markers) {
    std::mt19937_64 generator(seed);
    Bytes bytes;
    for (std::size_t i = 0; i < size; ++i) {
        const std::uint64_t draw = generator();
        const auto any = static_cast<std::byte>(draw & 0xFF);
        const std::uint64_t kind = is_rich_in_markers ? (draw >> 8) % 4 : 3;
        bytes.push_back(kind == 0 ? kStartByte : kind == 1 ? kEndByte : any);
    }
    return bytes;
}

}  // namespace a351::wire
