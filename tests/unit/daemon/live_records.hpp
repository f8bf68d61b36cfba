#pragma once

#include "daemon/live/live_record.hpp"
#include "tests/unit/daemon/fake_recorder.hpp"

namespace a351::daemon {

inline live::Record quiet_live_record() { return {*wire::find_profile("A351"), 50, {}}; }

/// Returns the time of sample `index` at 50 Hz; sample 0 is at kMorning.
inline UtcTime instant_of(std::int64_t index) {
    return kMorning + index * std::chrono::milliseconds(20);
}

/// Returns a sample whose counts show its index: index + 1000 x the number of the channel.
inline live::PlacedSample numbered_sample(std::int64_t index) {
    live::PlacedSample sample{index, instant_of(index), {}};
    for (std::size_t channel = 0; channel < live::kLiveChannelCount; ++channel) {
        sample.counts[channel] =
            static_cast<std::int32_t>(index + 1000 * static_cast<std::int64_t>(channel));
    }
    return sample;
}

/// Adds the samples first, first + 1 ... last - 1.
inline void take_samples(live::Record& live, std::int64_t first, std::int64_t last) {
    for (std::int64_t index = first; index < last; ++index) live.take(numbered_sample(index));
}

}  // namespace a351::daemon
