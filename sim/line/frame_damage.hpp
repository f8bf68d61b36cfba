#pragma once
/// @file
/// Ways to spoil a frame so that surely no receiver that checks markers and checksum takes it.

#include <cstddef>
#include <span>
#include <vector>

#include "sim/noise/random.hpp"

namespace a351::sim {

using Bytes = std::vector<std::byte>;

/// The frame carries a checksum, and it is right.
[[nodiscard]] bool has_right_checksum(std::span<const std::byte> frame);

/// Flips `bits` different bits of one 16-bit word, checksum included, or of a marker (8 at most):
/// bits of one word always change the sum.  The place is drawn.
[[nodiscard]] Bytes with_flipped_bits(std::span<const std::byte> frame, int bits,
                                      RandomStream& random);

/// Changes nothing but the checksum.  Precondition: has_right_checksum().
[[nodiscard]] Bytes with_bad_checksum(std::span<const std::byte> frame, RandomStream& random);

/// Without `count` bytes in a row, all but one at most, somewhere.
[[nodiscard]] Bytes without_bytes(std::span<const std::byte> frame, int count,
                                  RandomStream& random);

/// With `count` bytes more, somewhere behind the first.  A frame without checksum gets none that are
/// markers; where its own bytes are, so that a frame is left wherever they come, nobody can tell.
[[nodiscard]] Bytes with_more_bytes(std::span<const std::byte> frame, int count,
                                    RandomStream& random);

/// Its front, one byte at least and the end marker never.
[[nodiscard]] Bytes cut_short(std::span<const std::byte> frame, RandomStream& random);

/// Drawn bytes to come before `frame`: any value, but no markers if it has no checksum, since
/// markers alone would then make frames.
[[nodiscard]] Bytes garbage_before(std::span<const std::byte> frame, int count,
                                   RandomStream& random);

/// `answer` sent while `frame` was under way.
[[nodiscard]] Bytes cut_by_answer(std::span<const std::byte> frame,
                                  std::span<const std::byte> answer, RandomStream& random);

}  // namespace a351::sim
