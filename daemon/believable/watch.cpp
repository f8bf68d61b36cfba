#include "daemon/believable/watch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace a351::daemon::believable {

void Watch::end_of_history() {
    restart();
    rest_.end_of_history();
}

void Watch::forget() {
    restart();
    rest_ = RestWatch(profile_);
}

void Watch::restart() {
    rest_.interrupt();
    axes_ = AxesWatch(profile_);
    temperature_ = TemperatureWatch(profile_);
    last_.reset();
    count_ = 0;
}

void Watch::take(UtcTime time, const Counts& counts) {
    if (last_ && std::abs(seconds_between(*last_, time)) > kLongGap_s) restart();
    if (!last_) before_ = counts;
    last_ = time;
    if (count_ == 0) second_ = {};
    for (std::size_t i = 0; i < counts.size(); ++i) {
        Second::Range& range = second_.channels[i];
        range.least = count_ == 0 ? counts[i] : std::min(range.least, counts[i]);
        range.most = count_ == 0 ? counts[i] : std::max(range.most, counts[i]);
        range.mean += counts[i];
        const auto differences = std::bit_cast<std::uint32_t>(before_[i] ^ counts[i]);
        for (std::size_t byte = 0; byte < range.byte_changes.size(); ++byte)
            range.byte_changes[byte] += (differences >> (8 * byte) & 0xFF) != 0 ? 1.0 : 0.0;
    }
    before_ = counts;
    if (++count_ < rate_hz_) return;
    for (Second::Range& range : second_.channels) {
        range.mean /= rate_hz_;
        for (double& changes : range.byte_changes) changes /= rate_hz_;
    }
    second_.end = time;
    count_ = 0;
    axes_.take(second_);
    rest_.take(second_);
    temperature_.take(second_);
}

std::vector<text::Message> Watch::troubles() const {
    std::vector<text::Message> troubles;
    axes_.append_troubles(troubles);
    rest_.append_troubles(troubles);
    temperature_.append_troubles(troubles);
    return troubles;
}

}  // namespace a351::daemon::believable
