#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "daemon/live/history.hpp"

namespace a351::daemon::page {

/// A message of the live stream, encoded once for all viewers.
struct LiveMessage {
    bool is_text = false;
    std::string bytes;
};

/// Encodes a block in the binary form of the live stream, little endian:
///
///     offset 0   u8   version, 1
///            1   u8   kind, 1: samples
///            2   u16  mask of the channels: bit 0 x, 1 y, 2 z, 3 temperature
///            4   u32  count of samples
///            8   i64  index of the first sample in its session, or in the data that a restarted
///                     daemon loaded from the archive
///           16   f64  Unix time of the first sample, ms
///           24   f64  sample interval, ms
///           32   i32  `count` values in counts for each channel in the mask, lowest bit first
[[nodiscard]] std::string encoded(const live::Block& block);

inline constexpr std::size_t kLiveHeaderSize = 32;
inline constexpr std::size_t kLargestLiveMessage = std::size_t{64} * 1024;
inline constexpr std::size_t kMostSamplesPerMessage =
    (kLargestLiveMessage - kLiveHeaderSize) / (live::kLiveChannelCount * sizeof(std::int32_t));

/// The newest messages, for viewers that each continue reading at their own position.  Memory is
/// limited: a viewer that reads too slowly misses messages and delays nobody.
class LiveMessages {
public:
    void push(LiveMessage message);

    /// Returns the number of messages so far: the position of a viewer that wants only new ones.
    [[nodiscard]] std::uint64_t end() const noexcept { return end_; }

    /// Returns the message at `position`, or the oldest stored one, and moves `position` past it.
    /// Adds the number of missed messages to `missed`.  Null: nothing new.
    [[nodiscard]] std::shared_ptr<const LiveMessage> next(std::uint64_t& position,
                                                          std::uint64_t& missed) const;

private:
    std::deque<std::shared_ptr<const LiveMessage>> messages_;
    std::size_t byte_count_ = 0;
    std::uint64_t end_ = 0;
};

/// Most messages kept: six seconds at 50 Hz, one and a half at 50 000 samples/s.
inline constexpr std::size_t kMostMessagesKept = 64;
inline constexpr std::size_t kMostBytesKept = std::size_t{1024} * 1024;

}  // namespace a351::daemon::page
