#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "protocol/core/utc_time.hpp"

namespace a351::daemon {

inline constexpr std::size_t kLiveChannelCount = 4;
enum class LiveChannel : std::size_t { x, y, z, temperature };

/// A sample as the archive has it.
struct PlacedSample {
    std::int64_t index = 0;  ///< Of the session; of the archive's past, which knows none, any.
    UtcTime time;
    std::array<std::int32_t, kLiveChannelCount> counts{};  ///< In the order of LiveChannel.
};

/// Samples that follow each other without a gap.
struct LiveBlock {
    std::int64_t first_index = 0;
    UtcTime first_time;
    double interval_s = 0.0;
    std::array<std::vector<std::int32_t>, kLiveChannelCount> counts;
};

/// The last samples at full rate, for viewers that each read on from where they were.
class RecentSamples {
public:
    /// @param capacity  > 0, samples.
    RecentSamples(std::size_t capacity, double interval_s);

    void take(const PlacedSample& sample);

    /// Samples taken so far: the cursor of a viewer that has seen all.
    [[nodiscard]] std::uint64_t end() const noexcept { return end_; }

    /// Up to `most` samples from `cursor` on, which moves behind them.  A cursor older than what is
    /// kept begins with the oldest.  std::nullopt: nothing new.
    [[nodiscard]] std::optional<LiveBlock> block_from(std::uint64_t& cursor,
                                                      std::size_t most) const;

    /// Mean counts of the last `count` samples; std::nullopt while there are fewer, or a gap is
    /// among them.
    [[nodiscard]] std::optional<std::array<double, kLiveChannelCount>> mean_of_last(
        std::size_t count) const;

private:
    [[nodiscard]] bool follows(std::size_t i) const;  ///< samples_[i] the one before it.

    std::size_t capacity_;
    double interval_s_;
    std::deque<PlacedSample> samples_;
    std::uint64_t end_ = 0;
};

}  // namespace a351::daemon
