#include "protocol/wire/burst_decoder.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace a351::wire {
namespace {

using Bytes = std::span<const std::byte>;
using Reason = Discarded::Reason;

constexpr std::uint16_t kHalfWrap = 0x8000;
constexpr std::size_t kFramesInARow = 3;

std::int32_t read_i32(Bytes bytes, std::size_t at) noexcept {
    return static_cast<std::int32_t>((std::uint32_t{word_at(bytes, at)} << 16U) |
                                     word_at(bytes, at + 2));
}

std::size_t tail_size(const BurstLayout& layout) noexcept {
    return layout.has_checksum() ? 3 : 1;  // checksum and end byte
}

std::uint16_t count_of(const BurstLayout& layout, Bytes frame) noexcept {
    return word_at(frame, frame.size() - tail_size(layout) - 2);
}

/// Returns the fault of a single frame, if it has one; other frames are not considered.
std::optional<Reason> find_fault(const BurstLayout& layout, Bytes frame) noexcept {
    if (frame.front() != kStartByte) return Reason::no_start_byte;
    if (frame.back() != kEndByte) return Reason::bad_end_byte;
    if (layout.has_checksum()) {
        const std::size_t at = frame.size() - tail_size(layout);
        if (word_at(frame, at) != burst_checksum(frame.subspan(1, at - 1)))
            return Reason::bad_checksum;
    }
    return std::nullopt;
}

BurstValues read_values(const BurstLayout& layout, Bytes frame) noexcept {
    BurstValues values;
    std::size_t at = 1;
    if (layout.has_flag()) {
        values.flag = word_at(frame, at);
        at += 2;
    }
    if (layout.has_temperature()) {
        values.temperature = read_i32(frame, at);
        at += 4;
    }
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
        if (layout.has_axis(axis)) {
            values.axes[static_cast<std::size_t>(axis)] = read_i32(frame, at);
            at += 4;
        }
    }
    if (layout.has_count()) values.count = word_at(frame, at);
    return values;
}

}  // namespace

BurstDecoder::BurstDecoder(BurstLayout layout, std::uint16_t count_step) noexcept
    : layout_(layout), count_step_(count_step), frame_size_(layout.frame_size()) {
    assert(count_step > 0);
}

std::optional<DecoderEvent> BurstDecoder::next(Bytes& input) noexcept {
    if (pending_size_ == 0 && follows_frame_ && input.size() >= frame_size_) {
        const Bytes frame = input.first(frame_size_);
        if (!find_fault(layout_, frame)) {
            input = input.subspan(frame_size_);
            return accept(frame);
        }
    }
    for (;;) {
        const Decision decision = decide(Bytes(pending_).first(pending_size_));
        switch (decision.kind) {
            case Decision::Kind::undecided: {
                if (input.empty()) return std::nullopt;
                const std::size_t taken =
                    std::min(decision.bytes_needed - pending_size_, input.size());
                std::copy_n(input.begin(), taken, pending_.begin() + pending_size_);
                pending_size_ += taken;
                input = input.subspan(taken);
                break;
            }
            case Decision::Kind::accept: {
                // The next call accepts it.
                if (run_.byte_count > 0) return std::exchange(run_, {});
                const BurstFrame frame = accept(Bytes(pending_).first(frame_size_));
                drop_front(frame_size_);
                return frame;
            }
            case Decision::Kind::reject: {
                if (run_.byte_count == 0) run_.reason = decision.reason;
                ++run_.byte_count;
                follows_frame_ = false;
                drop_front(1);
                if (run_.byte_count == frame_size_) return std::exchange(run_, {});
                break;
            }
        }
    }
}

/// Decides if a frame starts at the front of `bytes`.  More bytes may settle an undecided case but
/// never change a decision, so the events do not depend on how the stream is cut.
BurstDecoder::Decision BurstDecoder::decide(Bytes bytes) const noexcept {
    if (!bytes.empty() && bytes.front() != kStartByte) {
        return {.kind = Decision::Kind::reject, .reason = Reason::no_start_byte};
    }
    if (bytes.size() < frame_size_) {
        return {.kind = Decision::Kind::undecided, .bytes_needed = frame_size_};
    }
    const Bytes frame = bytes.first(frame_size_);
    if (const auto fault = find_fault(layout_, frame)) {
        return {.kind = Decision::Kind::reject, .reason = *fault};
    }
    if (follows_frame_) return {.kind = Decision::Kind::accept};
    if (!layout_.has_checksum()) return confirm_in_a_row(bytes);
    if (has_accepted_ &&
        (!layout_.has_count() || is_count_ahead(count_of(layout_, frame), last_count_))) {
        return {.kind = Decision::Kind::accept};
    }
    return confirm_with_checksum(bytes);
}

BurstDecoder::Decision BurstDecoder::confirm_with_checksum(Bytes bytes) const noexcept {
    const Bytes held = bytes.first(frame_size_);
    for (std::size_t at = frame_size_; at + frame_size_ <= bytes.size(); ++at) {
        const Bytes frame = bytes.subspan(at, frame_size_);
        if (find_fault(layout_, frame)) continue;
        if (!layout_.has_count() ||
            is_count_ahead(count_of(layout_, frame), count_of(layout_, held))) {
            return {.kind = Decision::Kind::accept};
        }
    }
    const std::size_t look_ahead = kLookAheadFrames * frame_size_;
    if (bytes.size() < look_ahead) {
        return {.kind = Decision::Kind::undecided, .bytes_needed = look_ahead};
    }
    return {.kind = Decision::Kind::reject, .reason = Reason::unconfirmed};
}

BurstDecoder::Decision BurstDecoder::confirm_in_a_row(Bytes bytes) const noexcept {
    for (std::size_t at = frame_size_; at < kFramesInARow * frame_size_; at += frame_size_) {
        if (bytes.size() < at + frame_size_) {
            return {.kind = Decision::Kind::undecided, .bytes_needed = at + frame_size_};
        }
        const Bytes before = bytes.subspan(at - frame_size_, frame_size_);
        const Bytes frame = bytes.subspan(at, frame_size_);
        if (find_fault(layout_, frame) ||
            (layout_.has_count() &&
             !is_count_ahead(count_of(layout_, frame), count_of(layout_, before)))) {
            return {.kind = Decision::Kind::reject, .reason = Reason::unconfirmed};
        }
    }
    return {.kind = Decision::Kind::accept};
}

bool BurstDecoder::is_count_ahead(std::uint16_t count, std::uint16_t previous) const noexcept {
    const auto ahead = static_cast<std::uint16_t>(count - previous);
    return ahead > 0 && ahead <= kHalfWrap && ahead % count_step_ == 0;
}

BurstFrame BurstDecoder::accept(Bytes frame) noexcept {
    const BurstValues values = read_values(layout_, frame);
    follows_frame_ = true;
    has_accepted_ = true;
    last_count_ = values.count;
    return BurstFrame(values);
}

void BurstDecoder::drop_front(std::size_t byte_count) noexcept {
    std::copy(pending_.begin() + byte_count, pending_.begin() + pending_size_, pending_.begin());
    pending_size_ -= byte_count;
}

}  // namespace a351::wire
