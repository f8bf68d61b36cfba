#include "daemon/live/history.hpp"

#include <algorithm>
#include <cmath>

namespace a351::daemon::live {
namespace {

constexpr Nanoseconds kBin = std::chrono::seconds(2);

std::int64_t bin_of(UtcTime time) {
    const auto since = time.time_since_epoch().count(), width = kBin.count();
    return since / width - (since % width < 0 ? 1 : 0);
}

UtcTime begin_of(std::int64_t bin) { return UtcTime(kBin * bin); }

}  // namespace

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

std::optional<Block> RecentSamples::block_from(std::uint64_t& cursor, std::size_t most) const {
    const std::uint64_t oldest = end_ - samples_.size();
    cursor = std::clamp(cursor, oldest, end_);
    if (cursor == end_ || most == 0) return std::nullopt;
    const auto begin = static_cast<std::size_t>(cursor - oldest);
    const std::size_t limit = std::min(samples_.size(), begin + most);
    std::size_t end = begin + 1;
    while (end < limit && follows(end)) ++end;

    Block block;
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

void History::take(UtcTime time, const std::array<float, kLiveChannelCount>& values) {
    const std::int64_t number = bin_of(time);
    // If time is set back, later bins are removed.
    while (!bins_.empty() && bins_.back().number > number) bins_.pop_back();
    if (bins_.empty() || bins_.back().number != number) {
        bins_.push_back({number, values, values});
        while (bins_.front().number < number - kHistoryKept / kBin) bins_.pop_front();
        return;
    }
    Bin& bin = bins_.back();
    for (std::size_t channel = 0; channel < kLiveChannelCount; ++channel) {
        bin.low[channel] = std::min(bin.low[channel], values[channel]);
        bin.high[channel] = std::max(bin.high[channel], values[channel]);
    }
}

std::vector<Envelope> History::envelopes(Channel channel, UtcTime from, UtcTime to,
                                         std::size_t points) const {
    std::vector<Envelope> found;
    if (bins_.empty() || to <= from || points == 0) return found;
    const std::int64_t first = std::max(bin_of(from), bins_.front().number);
    const std::int64_t last = std::min(bin_of(to - Nanoseconds(1)), bins_.back().number);
    if (last < first) return found;
    // Groups begin at multiples of their length, so that they stay the same as time continues.
    const auto wanted = static_cast<std::int64_t>(points);
    std::int64_t group = (last - first) / wanted + 1;
    while (last / group - first / group + 1 > wanted) ++group;

    const auto c = static_cast<std::size_t>(channel);
    const auto begin = std::lower_bound(bins_.begin(), bins_.end(), first,
                                        [](const Bin& bin, auto n) { return bin.number < n; });
    std::int64_t number = -1;
    for (auto bin = begin; bin != bins_.end() && bin->number <= last; ++bin) {
        if (found.empty() || bin->number / group != number) {
            number = bin->number / group;
            found.push_back({begin_of(number * group),
                             std::chrono::duration<double>(kBin * group).count(), bin->low[c],
                             bin->high[c]});
        }
        found.back().low = std::min(found.back().low, bin->low[c]);
        found.back().high = std::max(found.back().high, bin->high[c]);
    }
    return found;
}

}  // namespace a351::daemon::live
