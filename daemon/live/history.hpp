#pragma once
/// @file
/// Recorded samples in memory: the last ones at full rate, and the last day as envelopes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "protocol/core/utc_time.hpp"

namespace a351::daemon::live {

inline constexpr std::size_t kLiveChannelCount = 4;
enum class Channel : std::size_t { x, y, z, temperature };

/// A sample with its index and time.
struct PlacedSample {
    std::int64_t index = 0;  ///< Index in its session; arbitrary if loaded from the archive.
    UtcTime time;
    std::array<std::int32_t, kLiveChannelCount> counts{};  ///< In the order of Channel.
};

/// Samples that follow each other without a gap.
struct Block {
    std::int64_t first_index = 0;
    UtcTime first_time;
    double interval_s = 0.0;
    std::array<std::vector<std::int32_t>, kLiveChannelCount> counts;
};

/// The last samples at full rate, for viewers that each continue reading at their own position.
class RecentSamples {
public:
    /// @param capacity  number of samples, > 0.
    RecentSamples(std::size_t capacity, double interval_s)
        : capacity_(capacity), interval_s_(interval_s) {}

    void take(const PlacedSample& sample);

    /// Returns the number of samples taken so far: the cursor of a viewer that has seen all.
    [[nodiscard]] std::uint64_t end() const noexcept { return end_; }

    /// Returns up to `most` samples from `cursor` on, without a gap, moving `cursor` past them.
    /// A cursor older than the stored samples begins with the oldest.  std::nullopt: nothing new.
    [[nodiscard]] std::optional<Block> block_from(std::uint64_t& cursor, std::size_t most) const;

    /// Returns the mean counts of the last `count` samples; std::nullopt if there are fewer, or a
    /// gap is among them.
    [[nodiscard]] std::optional<std::array<double, kLiveChannelCount>> mean_of_last(
        std::size_t count) const;

private:
    /// Returns true if samples_[i] follows the one before it without a gap.
    [[nodiscard]] bool follows(std::size_t i) const;

    std::size_t capacity_;
    double interval_s_;
    std::deque<PlacedSample> samples_;
    std::uint64_t end_ = 0;
};

/// Smallest and largest value within [time, time + interval).
struct Envelope {
    UtcTime time;
    double interval_s = 0.0;
    float low = 0.0F, high = 0.0F;
};

/// Length of the history.
inline constexpr Nanoseconds kHistoryKept = std::chrono::hours(24);

/// The last day as envelopes of 2 s, in the channels' units.
class History {
public:
    void take(UtcTime time, const std::array<float, kLiveChannelCount>& values);

    /// Returns the envelopes that touch [from, to).  Neighbours are joined so that at most `points`
    /// (>= 1) remain.  There is none where nothing was recorded.
    [[nodiscard]] std::vector<Envelope> envelopes(Channel channel, UtcTime from, UtcTime to,
                                                  std::size_t points) const;

private:
    struct Bin {
        std::int64_t number = 0;  ///< Number of 2 s intervals since 1970.
        std::array<float, kLiveChannelCount> low{}, high{};
    };
    std::deque<Bin> bins_;  ///< Ascending.
};

}  // namespace a351::daemon::live
