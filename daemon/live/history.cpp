#include "daemon/live/history.hpp"

#include <algorithm>

namespace a351::daemon {
namespace {

constexpr Nanoseconds kBin = std::chrono::seconds(2);

std::int64_t bin_of(UtcTime time) {
    const auto since = time.time_since_epoch().count(), width = kBin.count();
    return since / width - (since % width < 0 ? 1 : 0);
}

UtcTime begin_of(std::int64_t bin) { return UtcTime(kBin * bin); }

}  // namespace

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

std::vector<LiveEnvelope> History::envelopes(LiveChannel channel, UtcTime from, UtcTime to,
                                             std::size_t points) const {
    std::vector<LiveEnvelope> found;
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

}  // namespace a351::daemon
