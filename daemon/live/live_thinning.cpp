#include "daemon/live/live_thinning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace a351::daemon::live {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLongestFilledSeconds = 60.0;
constexpr int kMiddleRateHz = 5;

}  // namespace

Thinning::Thinning(const wire::DeviceProfile& profile, int rate_hz)
    : profile_(profile),
      interval_s_(1.0 / rate_hz),
      block_size_(static_cast<std::size_t>(2 * rate_hz)),
      to_5_hz_(signal::design_decimation(rate_hz / kMiddleRateHz)),
      by_ten_(signal::design_decimation(10)) {
    begin_run();
}

void Thinning::begin_run() {
    first_.assign(kLiveChannelCount, signal::Decimator(to_5_hz_));
    second_.assign(kLiveChannelCount, signal::Decimator(by_ten_));
    block_.fill({});
    thinned_.fill({});
    begins_.clear();
    last_.reset();
}

void Thinning::take(const PlacedSample& sample, std::vector<verdict::LiveSample>& output) {
    if (last_) {
        const auto steps = std::llround(seconds_between(*last_, sample.time) / interval_s_);
        if (steps < 1 || static_cast<double>(steps) * interval_s_ > kLongestFilledSeconds) {
            begin_run();
        } else {
            for (auto step = 1LL; step < steps; ++step)
                add(*last_ + from_seconds(interval_s_), {kNan, kNan, kNan, kNan}, output);
        }
    }
    if (!last_ && sample.index % static_cast<std::int64_t>(block_size_) != 0) return;
    Values values{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        values[axis] = to_milligal(profile_.acceleration(sample.counts[axis])).value();
    values[3] = profile_.temperature(sample.counts[3]).value();
    add(sample.time, values, output);
}

void Thinning::add(UtcTime time, const Values& values, std::vector<verdict::LiveSample>& output) {
    if (block_[0].empty()) begins_.push_back(time);
    for (std::size_t channel = 0; channel < kLiveChannelCount; ++channel)
        block_[channel].push_back(values[channel]);
    last_ = time;
    if (block_[0].size() == block_size_) push_block(output);
}

void Thinning::push_block(std::vector<verdict::LiveSample>& output) {
    const MilliGal shake = shake_of_block();
    for (std::size_t channel = 0; channel < kLiveChannelCount; ++channel) {
        at_5_hz_[channel].clear();
        first_[channel].push(block_[channel], at_5_hz_[channel]);
        second_[channel].push(at_5_hz_[channel], thinned_[channel]);
        block_[channel].clear();
    }
    for (std::size_t k = 0; k < thinned_[0].size(); ++k) {
        verdict::LiveSample sample;
        sample.time = begins_.front();
        begins_.pop_front();
        sample.seen_at = *last_;
        for (std::size_t axis = 0; axis < 3; ++axis)
            sample.axes[axis] = MilliGal(thinned_[axis][k]);
        sample.temperature = DegC(thinned_[3][k]);
        sample.shake = shake;
        output.push_back(sample);
    }
    for (auto& values : thinned_) values.clear();
}

/// Returns half the largest peak-to-peak value of the axes, without missing samples.
MilliGal Thinning::shake_of_block() const {
    double shake_mgal = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const double value : block_[axis]) {
            if (std::isnan(value)) continue;
            low = std::min(low, value);
            high = std::max(high, value);
        }
        if (high > low) shake_mgal = std::max(shake_mgal, 0.5 * (high - low));
    }
    return MilliGal(shake_mgal);
}

}  // namespace a351::daemon::live
