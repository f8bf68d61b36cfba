#pragma once
/// @file
/// Sensor byte stream -> verified burst frames.  No I/O, no allocation, no exceptions.
/// Byte layout and checksum: protocol/wire/burst-format.md.

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
struct Discarded {
    enum class Reason { no_start_byte, bad_checksum, bad_end_byte, unconfirmed };
    Reason reason = Reason::no_start_byte;  ///< Reason for rejecting the first byte of the run.
    std::size_t byte_count = 0;  ///< 1 ... frame size; a longer run gives several events.
};

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
class BurstDecoder {
public:
    /// @param count_step  COUNT increment between frames, > 0.
    BurstDecoder(BurstLayout layout, std::uint16_t count_step) noexcept;

    /// Takes bytes from the front of `input` until one event is complete; std::nullopt means
    /// `input` is used up and an unfinished frame waits for more.
    ///
    ///     while (auto event = decoder.next(input)) std::visit(handle, *event);
    ///
    /// The events do not depend on where the caller cuts the stream.
    [[nodiscard]] std::optional<DecoderEvent> next(std::span<const std::byte>& input) noexcept;

    /// Returns the number of bytes taken that no event covers yet.
    [[nodiscard]] std::size_t pending_bytes() const noexcept {
        return run_.byte_count + pending_size_;
    }

private:
    static constexpr std::size_t kLookAheadFrames = 4;

    struct Verdict {
        enum class Kind { accept, reject, undecided } kind;
        Discarded::Reason reason = Discarded::Reason::no_start_byte;  ///< If rejected.
        std::size_t bytes_needed = 0;                                 ///< If undecided.
    };

    [[nodiscard]] Verdict judge(std::span<const std::byte> bytes) const noexcept;
    [[nodiscard]] Verdict confirm_with_checksum(std::span<const std::byte> bytes) const noexcept;
    [[nodiscard]] Verdict confirm_in_a_row(std::span<const std::byte> bytes) const noexcept;
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
