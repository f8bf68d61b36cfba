#include "daemon/verdict/touch_watch.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/units.hpp"
#include "protocol/signal/median.hpp"

namespace a351::daemon::verdict {
namespace {

constexpr std::size_t kMinute = 30;           ///< Samples in a minute.
constexpr std::size_t kHour = 60;             ///< Minutes in an hour.
constexpr std::size_t kUsualMinutes = 10;     ///< Least number of minutes for the usual noise.
constexpr std::size_t kUsualShakes = 300;     ///< Samples for the usual shaking: ten minutes.
constexpr double kLongestTailSeconds = 30.0;  ///< Longest end of a knock.

double rms_about_mean(const std::deque<double>& values) {
    double mean = 0.0, square = 0.0;
    for (const double value : values) mean += value;
    mean /= static_cast<double>(values.size());
    for (const double value : values) square += (value - mean) * (value - mean);
    return std::sqrt(square / static_cast<double>(values.size()));
}

}  // namespace

void TouchWatch::take(const LiveSample& sample) {
    follow_shake(sample);
    const double x = sample.axes[0].value(), y = sample.axes[1].value(), z = sample.axes[2].value();
    if (!std::isfinite(x + y + z) || !is_clean(sample)) return;
    follow_tilt(sample);
    follow_noise(sample);
}

bool TouchWatch::is_clean(const LiveSample& sample) const noexcept {
    return !last_shaken_ || seconds_between(*last_shaken_, sample.time) > kReachSeconds;
}

/// Follows knocks: begin above the threshold, end when shaking is at its usual level again.
void TouchWatch::follow_shake(const LiveSample& sample) {
    const double shake_mgal = sample.shake.value();
    if (!std::isfinite(shake_mgal)) return;
    shakes_mgal_.push_back(shake_mgal);
    if (shakes_mgal_.size() > kUsualShakes) shakes_mgal_.pop_front();
    const double usual_mgal = signal::median({shakes_mgal_.begin(), shakes_mgal_.end()});
    const bool is_shaking = shake_mgal > std::max(kMilliGalPerGal * options_.shake_gal,
                                                  options_.shake_factor * usual_mgal);
    if (is_shaking) last_shaking_ = sample.seen_at;
    if (shake_mgal > kMilliGalPerGal * options_.knock_gal) {
        last_shaken_ = sample.seen_at;
    } else if (!knock_begun_ || !is_shaking ||
               seconds_between(*last_shaken_, sample.seen_at) > kLongestTailSeconds) {
        knock_begun_.reset();
        return;
    }
    if (!knock_begun_) knock_begun_ = sample.seen_at - from_seconds(kLiveStepSeconds);
    last_knock_ = sample.seen_at;
    if (seconds_between(*knock_begun_, sample.seen_at) > options_.handled_s)
        last_handled_ = sample.seen_at;
}

/// Compares the axes of a minute ago with those of now.
void TouchWatch::follow_tilt(const LiveSample& sample) {
    tilts_mgal_.push_back({sample.axes[0].value(), sample.axes[1].value(), sample.axes[2].value()});
    if (tilts_mgal_.size() <= kMinute) return;
    // The vertical axis changes only with the square of the tilt, so which one it is has no effect.
    std::array<double, 3> change_mgal{};
    for (std::size_t axis = 0; axis < change_mgal.size(); ++axis)
        change_mgal[axis] = tilts_mgal_.back()[axis] - tilts_mgal_.front()[axis];
    tilts_mgal_.pop_front();
    const double most_mgal = kMilliGalPerStandardGravity * options_.tilt_deg * kRadPerDeg;
    if (std::hypot(change_mgal[0], change_mgal[1], change_mgal[2]) > most_mgal) {
        last_handled_ = last_knock_ = sample.seen_at;
        tilts_mgal_.clear();
        norms_mgal_.clear();
    }
}

void TouchWatch::follow_noise(const LiveSample& sample) {
    norms_mgal_.push_back(
        std::hypot(sample.axes[0].value(), sample.axes[1].value(), sample.axes[2].value()));
    if (norms_mgal_.size() > kMinute) norms_mgal_.pop_front();
    if (norms_mgal_.size() < kMinute) {
        noise_mgal_ = 0.0;
        return;
    }
    noise_mgal_ = rms_about_mean(norms_mgal_);
    if (++since_minute_ < static_cast<int>(kMinute)) return;
    since_minute_ = 0;
    minutes_mgal_.push_back(noise_mgal_);
    if (minutes_mgal_.size() > kHour) minutes_mgal_.pop_front();
}

double TouchWatch::noise_ratio() const noexcept {
    if (minutes_mgal_.size() < kUsualMinutes) return 1.0;
    const double usual = signal::median({minutes_mgal_.begin(), minutes_mgal_.end()});
    return noise_mgal_ / std::max(usual, options_.noise_floor_mgal);
}

}  // namespace a351::daemon::verdict
