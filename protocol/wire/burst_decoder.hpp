#pragma once
/// @file
/// Sensor byte stream -> verified burst frames.  No I/O, no allocation, no exceptions.
/// Byte layout and checksum: protocol/wire/burst-format.md.
///
/// Use one decoder for one uninterrupted stream, from the start command on, and a new one when
/// layout or rate change.  Feed it everything received, in order, in pieces of any size:
///
///     BurstDecoder decoder(layout, profile.count_step(output_rate_hz));
///     while (const std::size_t size = read(buffer)) {
///         std::span<const std::byte> input = std::span(buffer).first(size);
///         while (const auto event = decoder.next(input)) {
///             if (const auto* frame = std::get_if<BurstFrame>(&*event)) use(frame->values());
///             else count(std::get<Discarded>(*event));
///         }
///     }
///
/// The decoder does not count lost samples: compare the COUNT of consecutive frames, as
/// timing::SampleIndex does.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "protocol/wire/burst_frame.hpp"

namespace a351::wire {

/// Run of bytes that belongs to no valid frame.  Every loss is reported as such an event; the
/// caller counts and reports it.
///
/// Each byte of a run was rejected as the start of a frame, in this order of checks:
/// - `no_start_byte`: it is not kStartByte.  At the begin of a stream, or after lost bytes.
/// - `bad_end_byte`: it is, but kEndByte is missing one frame length later.
/// - `bad_checksum`: both markers are right, the checksum is not.  Mostly a damaged frame.
/// - `unconfirmed`: the frame is right, but no second one confirmed it.  Mostly chance in noise.
///
/// Many events without a frame in between mean that baud rate or layout differ from the device's.
struct Discarded {
    enum class Reason { no_start_byte, bad_checksum, bad_end_byte, unconfirmed };
    Reason reason = Reason::no_start_byte;  ///< Reason for rejecting the first byte of the run.
    std::size_t byte_count = 0;  ///< 1 ... frame size; a longer run gives several events.
};

/// Frame, which covers layout.frame_size() bytes, or run of rejected bytes.
using DecoderEvent = std::variant<BurstFrame, Discarded>;

/// Splits a byte stream into frames and discarded bytes.  Events come in the order of the bytes
/// they cover, and each byte belongs to exactly one event.  The position of an event in the stream
/// is therefore the sum of the sizes before it.
///
/// Rules for accepting a frame (they depend on the stream only, not on how it was cut):
/// - Directly after an accepted frame: start byte, end byte and, if present, checksum are right.
/// - After a loss, with checksum: the same, and COUNT is ahead of the last accepted frame by a
///   multiple of the step, at most half a wrap.  A layout without COUNT needs the checksum only.
/// - Anywhere else with checksum (start of the stream, implausible COUNT): a second right frame
///   with such a COUNT must end within kLookAheadFrames frame lengths of the start of the first
///   one.
/// - Anywhere else without checksum: three right frames in a row, each COUNT ahead of the previous.
/// A rejected frame costs one byte; the search continues at its second byte.
///
/// A frame can be reported later than its last byte arrives: it may have to wait for three more
/// frame lengths of bytes.  Take arrival times from positions in the stream, not from the call that
/// returned the frame.
///
/// Directly after an accepted frame any COUNT is accepted, even an equal one.  Duplicates and
/// restarts of the counter are left to the caller.
///
/// Memory is constant, below 200 bytes.  Cost per byte is bounded; while frames follow each other
/// within `input`, they are read in place.  An object can be copied, and has no locks: use it from
/// one thread at a time.
///
/// Accuracy (burst_decoder_damage_test.cpp): with CHKSM, a flipped bit loses exactly the frame it
/// hits, with or without COUNT.  With CHKSM and COUNT, a dropped byte costs one frame.  100 streams
/// of 10 kB of noise hold no frame, in layouts with and without checksum.
class BurstDecoder {
public:
    /// Starts at the begin of a stream: no COUNT is known.
    /// @param layout      layout of the device; frames of another one are not found.
    /// @param count_step  COUNT increment between frames, > 0.  DeviceProfile::count_step() has it.
    ///                    Without COUNT in the layout it has no effect.
    BurstDecoder(BurstLayout layout, std::uint16_t count_step) noexcept;

    /// Takes bytes from the front of `input` until one event is complete; std::nullopt means
    /// `input` is used up and an unfinished frame waits for more.
    ///
    ///     while (auto event = decoder.next(input)) std::visit(handle, *event);
    ///
    /// The events do not depend on where the caller cuts the stream.
    ///
    /// After an event, `input` is what was not taken yet.  Call again with the same span until
    /// std::nullopt, even if it is empty, because further events may be complete.  The bytes are
    /// copied where necessary and need not outlive the call.
    [[nodiscard]] std::optional<DecoderEvent> next(std::span<const std::byte>& input) noexcept;

    /// Returns the number of bytes taken that no event covers yet.
    ///
    /// All bytes taken = frames x frame size + sum of Discarded::byte_count + pending_bytes().
    /// There is no flush: at the end of a stream, count these bytes as not framed.
    [[nodiscard]] std::size_t pending_bytes() const noexcept {
        return run_.byte_count + pending_size_;
    }

private:
    static constexpr std::size_t kLookAheadFrames = 4;

    struct Decision {
        enum class Kind { accept, reject, undecided } kind;
        Discarded::Reason reason = Discarded::Reason::no_start_byte;  ///< If rejected.
        std::size_t bytes_needed = 0;                                 ///< If undecided.
    };

    [[nodiscard]] Decision decide(std::span<const std::byte> bytes) const noexcept;
    [[nodiscard]] Decision confirm_with_checksum(std::span<const std::byte> bytes) const noexcept;
    [[nodiscard]] Decision confirm_in_a_row(std::span<const std::byte> bytes) const noexcept;
    [[nodiscard]] bool is_count_ahead(std::uint16_t count, std::uint16_t previous) const noexcept;
    [[nodiscard]] BurstFrame accept(std::span<const std::byte> frame) noexcept;
    void drop_front(std::size_t byte_count) noexcept;

    BurstLayout layout_;
    std::uint16_t count_step_;
    std::size_t frame_size_;
    std::array<std::byte, kLookAheadFrames * kLargestFrame> pending_{};
    std::size_t pending_size_ = 0;
    Discarded run_;               ///< Bytes given up, before `pending_`, not yet reported.
    bool follows_frame_ = false;  ///< True if the last decided byte ended an accepted frame.
    bool has_accepted_ = false;   ///< True once `last_count_` is known.
    std::uint16_t last_count_ = 0;
};

}  // namespace a351::wire
