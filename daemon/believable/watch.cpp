#include "daemon/believable/watch.hpp"

#include <algorithm>
#include <cmath>

namespace a351::daemon::believable {

void Watch::restart() {
    axes_ = AxesWatch(profile_);
    temperature_ = TemperatureWatch(profile_);
    last_.reset();
    count_ = 0;
}

void Watch::take(UtcTime time, const Counts& counts) {
    if (last_ && std::abs(seconds_between(*last_, time)) > kLongGap_s) restart();
    last_ = time;
    if (count_ == 0) second_ = {};
    for (std::size_t i = 0; i < counts.size(); ++i) {
        Second::Range& range = second_.channels[i];
        range.least = count_ == 0 ? counts[i] : std::min(range.least, counts[i]);
        range.most = count_ == 0 ? counts[i] : std::max(range.most, counts[i]);
        range.mean += counts[i];
    }
    if (++count_ < rate_hz_) return;
    for (Second::Range& range : second_.channels) range.mean /= rate_hz_;
    second_.end = time;
    count_ = 0;
    axes_.take(second_);
    temperature_.take(second_);
}

std::vector<text::Message> Watch::troubles() const {
    std::vector<text::Message> troubles;
    axes_.append_troubles(troubles);
    temperature_.append_troubles(troubles);
    return troubles;
}

}  // namespace a351::daemon::believable
