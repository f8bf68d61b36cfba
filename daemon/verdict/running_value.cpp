#include "daemon/verdict/running_value.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/units.hpp"

namespace a351::daemon::verdict {
namespace {

constexpr int kPerMinute = 30;
constexpr int kLeastMinutes = 3;  ///< Least number of minutes for an estimate of their scatter.

}  // namespace

void RunningValue::take(const LiveSample& sample) {
    if (sample.shake.value() > kMilliGalPerGal * options_.knock_gal) last_shaken_ = sample.seen_at;
    if (seconds_between(start_, sample.time) < kReachSeconds) return;
    const double norm_mgal =
        std::hypot(sample.axes[0].value(), sample.axes[1].value(), sample.axes[2].value());
    const bool is_clean =
        !last_shaken_ || seconds_between(*last_shaken_, sample.time) > kReachSeconds;
    if (!is_clean || !std::isfinite(norm_mgal)) {
        ++left_out_;
        return;
    }
    if (used_++ == 0) zero_mgal_ = norm_mgal;
    sum_mgal_ += norm_mgal - zero_mgal_;
    minute_sum_mgal_ += norm_mgal - zero_mgal_;
    if (++in_minute_ < kPerMinute) return;
    const double mean = minute_sum_mgal_ / kPerMinute;
    minutes_sum_ += mean;
    minutes_square_ += mean * mean;
    ++minutes_;
    minute_sum_mgal_ = 0.0;
    in_minute_ = 0;
}

RunningReading RunningValue::reading(MilliGal target, State state) const {
    RunningReading reading;
    reading.used_s = kLiveStepSeconds * used_;
    reading.left_out_s = kLiveStepSeconds * left_out_;
    if (used_ == 0) return reading;
    reading.value = MilliGal(zero_mgal_ + sum_mgal_ / used_);
    if (minutes_ < kLeastMinutes) return reading;

    const double about_mean = minutes_square_ - minutes_sum_ * minutes_sum_ / minutes_;
    const double variance = std::max(0.0, about_mean) / (minutes_ - 1);
    const double scatter = variance * kSecondsPerMinute;  // Divided by u below.
    const double cycle = options_.cycle_mgal / (2.0 * std::numbers::sqrt2);
    const double bend_s = options_.cycle_s / std::numbers::pi;
    const double share = std::min(1.0, bend_s / reading.used_s);
    const double square = scatter / reading.used_s + cycle * cycle * share * share;
    reading.standard_error = MilliGal(std::sqrt(square));
    if (state != State::stable) return reading;

    // scatter / u + (cycle bend / u)^2 = target^2
    const double wanted = target.value() * target.value();
    const double by_square = cycle * cycle * bend_s * bend_s;
    const double whole_s =
        (scatter + std::sqrt(scatter * scatter + 4.0 * wanted * by_square)) / (2.0 * wanted);
    reading.is_good_enough = square <= wanted;
    reading.needed_s = reading.is_good_enough ? 0.0 : std::max(0.0, whole_s - reading.used_s);
    return reading;
}

}  // namespace a351::daemon::verdict
