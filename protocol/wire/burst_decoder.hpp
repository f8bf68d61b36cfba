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
#include "protocol/wire/burst_layout.hpp"

namespace a351::wire {

/// A run of bytes that belongs to no valid frame.  Loss is an event like any other:
/// the caller counts it and says so; it is never swallowed here.
struct Discarded {
    enum class Reason { no_start_byte, bad_checksum, bad_end_byte, unconfirmed };
    Reason reason = Reason::no_start_byte;  ///< Why the first byte of the run was given up.
    std::size_t byte_count = 0;  ///< 1 ... frame size; a longer run comes as several events.
};

using DecoderEvent = std::variant<BurstFrame, Discarded>;

/// Events come in the order of the bytes they cover, and each byte ends up in exactly one, so the
/// position of an event in the stream is the sum of the sizes before it.
///
/// What counts as a frame (every rule looks at the stream only, never at how it was cut):
/// - Directly behind an accepted frame: start byte, end byte and, where present, checksum are right.
/// - After a loss, with checksum: the same, and COUNT lies ahead of the last accepted frame by a
///   multiple of the step and at most half a wrap.  A layout without COUNT has nothing to disagree.
/// - Anywhere else with checksum (start of the stream, implausible COUNT): the frame is held until a
///   second right frame with such a COUNT ends within kLookAheadFrames frame lengths of its start.
/// - Anywhere else without checksum: three right frames in a row, each COUNT ahead of the one before.
/// A frame refused costs one byte; the search goes on at the next one, inside the frame refused.
class BurstDecoder {
public:
    /// @param count_step  COUNT increment between frames; plausibility of a first frame.
    BurstDecoder(BurstLayout layout, std::uint16_t count_step) noexcept;

    /// Takes bytes from the front of `input` until one event is complete; std::nullopt means
    /// `input` is used up and an unfinished frame waits for more.
    ///
    ///     while (auto event = decoder.next(input)) std::visit(handle, *event);
    ///
    /// Where the caller cuts the stream changes no event.
    [[nodiscard]] std::optional<DecoderEvent> next(std::span<const std::byte>& input) noexcept;

    /// Bytes taken so far that no event covers yet.
    [[nodiscard]] std::size_t pending_bytes() const noexcept;

    [[nodiscard]] const BurstLayout& layout() const noexcept { return layout_; }

private:
    static constexpr std::size_t kLookAheadFrames = 4;

    struct Verdict {
        enum class Kind { accept, reject, undecided } kind;
        Discarded::Reason reason = Discarded::Reason::no_start_byte;  ///< For reject.
        std::size_t bytes_needed = 0;                                 ///< For undecided.
    };

    [[nodiscard]] Verdict judge(std::span<const std::byte> bytes) const noexcept;
    [[nodiscard]] Verdict confirm_with_checksum(std::span<const std::byte> bytes) const noexcept;
    [[nodiscard]] Verdict confirm_in_a_row(std::span<const std::byte> bytes) const noexcept;
    [[nodiscard]] bool is_count_ahead(std::uint16_t count, std::uint16_t previous) const noexcept;
    [[nodiscard]] BurstFrame accept(std::span<const std::byte> frame) noexcept;
    [[nodiscard]] DecoderEvent take_run() noexcept;
    void drop_front(std::size_t byte_count) noexcept;

    BurstLayout layout_;
    std::uint16_t count_step_;
    std::size_t frame_size_;
    std::array<std::byte, kLookAheadFrames * kLargestFrame> pending_{};
    std::size_t pending_size_ = 0;
    Discarded run_;                 ///< Bytes given up, before `pending_`, not yet reported.
    bool is_behind_frame_ = false;  ///< The last byte decided on ended an accepted frame.
    bool has_accepted_ = false;     ///< `last_count_` is known.
    std::uint16_t last_count_ = 0;
};

}  // namespace a351::wire
