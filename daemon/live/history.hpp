#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "daemon/live/recent_samples.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon {

/// Smallest and largest value within [time, time + interval).
struct LiveEnvelope {
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
    [[nodiscard]] std::vector<LiveEnvelope> envelopes(LiveChannel channel, UtcTime from, UtcTime to,
                                                      std::size_t points) const;

private:
    struct Bin {
        std::int64_t number = 0;  ///< Number of 2 s intervals since 1970.
        std::array<float, kLiveChannelCount> low{}, high{};
    };
    std::deque<Bin> bins_;  ///< Ascending.
};

}  // namespace a351::daemon
