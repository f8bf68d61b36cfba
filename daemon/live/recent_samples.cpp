#include "daemon/live/recent_samples.hpp"

#include <algorithm>
#include <cmath>

namespace a351::daemon {

RecentSamples::RecentSamples(std::size_t capacity, double interval_s)
    : capacity_(capacity), interval_s_(interval_s) {}

void RecentSamples::take(const PlacedSample& sample) {
    samples_.push_back(sample);
    if (samples_.size() > capacity_) samples_.pop_front();
    ++end_;
}

/// Checks index and time, because a new session may begin with the next index by chance.
bool RecentSamples::follows(std::size_t i) const {
    const PlacedSample& before = samples_[i - 1];
    const PlacedSample& sample = samples_[i];
    const double step_s = seconds_between(before.time, sample.time);
    return sample.index == before.index + 1 && std::abs(step_s - interval_s_) < 0.5 * interval_s_;
}

std::optional<LiveBlock> RecentSamples::block_from(std::uint64_t& cursor, std::size_t most) const {
    const std::uint64_t oldest = end_ - samples_.size();
    cursor = std::clamp(cursor, oldest, end_);
    if (cursor == end_ || most == 0) return std::nullopt;
    const auto begin = static_cast<std::size_t>(cursor - oldest);
    const std::size_t limit = std::min(samples_.size(), begin + most);
    std::size_t end = begin + 1;
    while (end < limit && follows(end)) ++end;

    LiveBlock block;
    block.first_index = samples_[begin].index;
    block.first_time = samples_[begin].time;
    block.interval_s = interval_s_;
    for (std::size_t channel = 0; channel < kLiveChannelCount; ++channel) {
        block.counts[channel].reserve(end - begin);
        for (std::size_t i = begin; i < end; ++i)
            block.counts[channel].push_back(samples_[i].counts[channel]);
    }
    cursor += end - begin;
    return block;
}

std::optional<std::array<double, kLiveChannelCount>> RecentSamples::mean_of_last(
    std::size_t count) const {
    if (count == 0 || samples_.size() < count) return std::nullopt;
    std::array<double, kLiveChannelCount> mean{};
    const std::size_t begin = samples_.size() - count;
    for (std::size_t i = begin; i < samples_.size(); ++i) {
        if (i > begin && !follows(i)) return std::nullopt;
        for (std::size_t channel = 0; channel < kLiveChannelCount; ++channel)
            mean[channel] += samples_[i].counts[channel];
    }
    for (double& value : mean) value /= static_cast<double>(count);
    return mean;
}

}  // namespace a351::daemon
