#pragma once
/// @file
/// Ways to damage a frame so that no receiver that checks markers and checksum accepts it.

#include <cstddef>
#include <span>
#include <vector>

#include "sim/noise/random.hpp"

namespace a351::sim::line {

using Bytes = std::vector<std::byte>;

/// Returns true if the frame has a checksum and it is right.
[[nodiscard]] bool has_right_checksum(std::span<const std::byte> frame);

/// Flips `bits` different bits of one 16-bit word, which may be the checksum, or of a marker (8 at
/// most).  Bits of a single word always change the sum.  The place is drawn.
[[nodiscard]] Bytes with_flipped_bits(std::span<const std::byte> frame, int bits,
                                      noise::RandomStream& random);

/// Changes only the checksum.  Precondition: has_right_checksum().
[[nodiscard]] Bytes with_bad_checksum(std::span<const std::byte> frame,
                                      noise::RandomStream& random);

/// Removes `count` bytes in a row at a drawn place; at least one byte remains.
[[nodiscard]] Bytes without_bytes(std::span<const std::byte> frame, int count,
                                  noise::RandomStream& random);

/// Inserts `count` bytes at a drawn place after the first byte.  A frame without checksum gets no
/// bytes that are markers.  Its own bytes may still form a frame at every place; such damage cannot
/// be detected.
[[nodiscard]] Bytes with_more_bytes(std::span<const std::byte> frame, int count,
                                    noise::RandomStream& random);

/// Keeps only the front: at least one byte, and never the end marker.
[[nodiscard]] Bytes cut_short(std::span<const std::byte> frame, noise::RandomStream& random);

/// Returns drawn bytes to send before `frame`.  If it has no checksum, they contain no markers,
/// because markers alone would make frames.
[[nodiscard]] Bytes garbage_before(std::span<const std::byte> frame, int count,
                                   noise::RandomStream& random);

/// Inserts `answer` into `frame` at a drawn place, as if sent while the frame was under way.
[[nodiscard]] Bytes cut_by_answer(std::span<const std::byte> frame,
                                  std::span<const std::byte> answer, noise::RandomStream& random);

}  // namespace a351::sim::line
