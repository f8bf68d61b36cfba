#include "protocol/wire/burst_decoder.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/wire/burst_stream.hpp"

namespace a351::wire {
namespace {

using Reason = Discarded::Reason;

const BurstLayout kFull = BurstLayout::recommended();

Event frame_event(const BurstLayout& layout, unsigned i) {
    return {.values = values_at(layout, i)};
}
Event discarded(Reason reason, std::size_t count) { return {.reason = reason, .discarded = count}; }

/// Returns healthy frames, lost and inserted bytes, flipped bits, false headers, and a restart of
/// the device.
Bytes rough_stream(const BurstLayout& layout) {
    Bytes damaged = frames(layout, 6, 2);
    damaged[3] ^= std::byte{0x10};
    damaged.back() = std::byte{0x00};
    Bytes short_of_a_byte = frames(layout, 10, 1);
    short_of_a_byte.erase(short_of_a_byte.begin() + 4);
    Bytes false_header = to_bytes({0x80, 0x80, 0x0D, 0x80});
    return joined({garbage(3, 37, true), frames(layout, 0, 6), damaged, frames(layout, 8, 2),
                   short_of_a_byte, frames(layout, 11, 3), false_header, frames(layout, 14, 4),
                   garbage(4, 61, true), frames(layout, 0, 5), to_bytes({0x80})});
}

}  // namespace

TEST_CASE("a stream cut at any byte, or into pieces of any size, decodes to the same events") {
    for (const int burst_ctrl : {0xC703, 0x4702, 0x0701, 0x0400}) {
        const BurstLayout layout = layout_of(burst_ctrl);
        const Bytes stream = rough_stream(layout);
        const auto whole = decode(layout, stream);
        REQUIRE(frames_in(whole).size() >= 12);
        for (std::size_t first = 0; first <= stream.size(); ++first) {
            for (const std::size_t size : {stream.size(), first}) {
                if (size == 0 || (size == first && size > 100)) continue;
                CAPTURE(burst_ctrl, first, size);
                BurstDecoder decoder(layout, kStep);
                std::vector<Event> events;
                feed(decoder, std::span(stream).first(first), events);
                for (std::size_t at = first; at < stream.size(); at += size)
                    feed(decoder, std::span(stream).subspan(at, std::min(size, stream.size() - at)),
                         events);
                REQUIRE(events == whole);
            }
        }
    }
}

TEST_CASE("each byte is in exactly one event or pending") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        CAPTURE(seed);
        std::mt19937_64 generator(seed);
        const BurstLayout layout = layout_of(seed % 2 == 0 ? 0xC703 : 0x4702);
        BurstDecoder decoder(layout, kStep);
        std::size_t fed = 0;
        std::size_t accounted = 0;
        for (unsigned i = 0; i < 60; ++i) {
            Bytes piece = generator() % 3 == 0 ? garbage(generator(), generator() % 90, true)
                                               : frames(layout, 3 * i, 1 + i % 3);
            if (generator() % 4 == 0 && !piece.empty()) piece.resize(generator() % piece.size());
            fed += piece.size();
            std::vector<Event> events;
            feed(decoder, piece, events);
            for (const Event& event : events) {
                REQUIRE(event.discarded <= layout.frame_size());
                accounted += event.is_frame() ? layout.frame_size() : event.discarded;
            }
            REQUIRE(accounted + decoder.pending_bytes() == fed);
        }
    }
}

TEST_CASE("a clean stream of any layout decodes without loss") {
    for (unsigned burst_ctrl = 0; burst_ctrl <= 0xFFFF; ++burst_ctrl) {
        const auto layout = BurstLayout::from_burst_ctrl(static_cast<std::uint16_t>(burst_ctrl));
        if (!layout) continue;
        CAPTURE(burst_ctrl);
        const auto events = decode(*layout, frames(*layout, 0, 1000));  // COUNT wraps
        REQUIRE(events.size() == 1000);
        for (unsigned i = 0; i < 1000; ++i) REQUIRE(events[i] == frame_event(*layout, i));
    }
}

TEST_CASE("the first frame is held until a second one confirms it") {
    BurstDecoder decoder(kFull, kStep);
    std::vector<Event> events;
    feed(decoder, frame_at(kFull, 0), events);
    CHECK(events.empty());
    CHECK(decoder.pending_bytes() == 24);
    feed(decoder, frame_at(kFull, 1), events);
    CHECK(events == std::vector{frame_event(kFull, 0), frame_event(kFull, 1)});
    CHECK(decoder.pending_bytes() == 0);
}

TEST_CASE("a held frame is confirmed even if two damaged frames follow it") {
    Bytes stream = frames(kFull, 0, 4);
    stream[30] ^= std::byte{1};
    stream[60] ^= std::byte{1};
    CHECK(decode(kFull, joined({to_bytes({1, 2, 3}), stream})) ==
          std::vector{discarded(Reason::no_start_byte, 3), frame_event(kFull, 0),
                      discarded(Reason::bad_checksum, 24), discarded(Reason::bad_checksum, 24),
                      frame_event(kFull, 3)});
}

TEST_CASE("a frame that is never confirmed is discarded and its bytes are reported") {
    const auto events = decode(kFull, joined({frame_at(kFull, 0), Bytes(96), Bytes(24)}));
    REQUIRE(events.size() == 6);
    CHECK(events[0] == discarded(Reason::unconfirmed, 24));
    CHECK(events[1] == discarded(Reason::no_start_byte, 24));

    BurstValues off_step = values_at(kFull, 1);  // A COUNT that does not follow confirms nothing.
    off_step.count = static_cast<std::uint16_t>(off_step.count + 1);
    Bytes stream = frame_at(kFull, 0);
    append_frame(kFull, off_step, stream);
    append_frame(kFull, off_step, stream);
    CHECK(frames_in(decode(kFull, joined({stream, Bytes(200)}))).empty());
}

TEST_CASE("without a checksum three frames in a row are required") {
    const BurstLayout layout = layout_of(0x4702);
    const Bytes gap = Bytes(7);
    CHECK(frames_in(decode(layout, joined({frames(layout, 0, 2), gap, Bytes(60)}))).empty());
    CHECK(frames_in(decode(layout, joined({gap, frames(layout, 0, 3)}))).size() == 3);
    CHECK(frames_in(decode(layout, joined({frames(layout, 0, 3), gap, frames(layout, 3, 2)})))
              .size() == 3);
    CHECK(frames_in(decode(layout, joined({frames(layout, 0, 3), gap, frames(layout, 3, 3)})))
              .size() == 6);
}

TEST_CASE(
    "without a checksum a constant field that looks like two markers is not taken for frames") {
    // X holds 0x000D80xx, so end and start byte recur one frame apart, two bytes into the field.
    const BurstLayout layout = layout_of(0x4702);
    Bytes stream;
    for (unsigned i = 0; i < 8; ++i) {
        BurstValues values = values_at(layout, i);
        values.axes[0] = 0x000D8000;
        append_frame(layout, values, stream);
    }
    stream.erase(stream.begin(), stream.begin() + 7);
    const auto found = frames_in(decode(layout, stream));
    REQUIRE(found.size() == 7);
    CHECK(found.front().count == 2 * kStep);
}

TEST_CASE("a frame directly after another one needs no plausible COUNT") {
    const Bytes stream = joined({frames(kFull, 50, 3), frames(kFull, 0, 1), frames(kFull, 0, 1)});
    CHECK(frames_in(decode(kFull, stream)).size() == 5);
}

TEST_CASE(
    "after a loss of up to half a counter wrap one frame is enough, after a longer one two are "
    "required") {
    const unsigned half_wrap = 0x8000 / kStep;  // 409 steps = 32720 counts
    for (const unsigned lost : {1U, 100U, half_wrap - 1, half_wrap}) {
        CAPTURE(lost);
        const Bytes stream = joined({frames(kFull, 0, 2), Bytes(3), frames(kFull, 2 + lost, 1)});
        CHECK(frames_in(decode(kFull, stream)).size() == (lost + 1 <= half_wrap ? 3 : 2));
    }
    BurstDecoder decoder(kFull, kStep);  // A restarted counter is like a longer loss.
    std::vector<Event> events;
    feed(decoder, joined({frames(kFull, 50, 3), Bytes(5), frames(kFull, 0, 1)}), events);
    CHECK(frames_in(events).size() == 3);
    feed(decoder, frames(kFull, 1, 1), events);
    CHECK(frames_in(events).size() == 5);
    CHECK(decoder.pending_bytes() == 0);
}

}  // namespace a351::wire
