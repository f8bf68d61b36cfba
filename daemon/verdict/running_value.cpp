#include "daemon/verdict/running_value.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/units.hpp"
#include "protocol/signal/distributions.hpp"

namespace a351::daemon::verdict {
namespace {

constexpr int kPerMinute = 30;
/// Least degrees of freedom for an estimate of the scatter: those of three minutes.
constexpr int kLeastDegrees = 2;

double mean_of(const std::vector<double>& values) {
    // Differences from the first value keep the digits of a sum of large numbers.
    double sum = 0.0;
    for (const double value : values) sum += value - values.front();
    return values.front() + sum / static_cast<double>(values.size());
}

/// Returns the standard deviation of at least two values.
double sd_of(const std::vector<double>& values) {
    const double mean = mean_of(values);
    double square = 0.0;
    for (const double value : values) square += (value - mean) * (value - mean);
    return std::sqrt(square / static_cast<double>(values.size() - 1));
}

std::array<MilliGal, 2> limits_of_sd(double sd_mgal, double degrees) {
    const auto at = [&](double quantile) {
        return MilliGal(sd_mgal *
                        std::sqrt(degrees / signal::chi_square_quantile(degrees, quantile)));
    };
    return {at(0.975), at(0.025)};
}

}  // namespace

void RunningValue::begin_set_up(UtcTime start) {
    set_ups_.push_back({start});
    last_shaken_.reset();
}

void RunningValue::take(const LiveSample& sample) {
    SetUp& now = set_ups_.back();
    if (sample.shake.value() > kMilliGalPerGal * options_.knock_gal) last_shaken_ = sample.seen_at;
    if (seconds_between(now.start, sample.time) < kReachSeconds) return;
    const double norm_mgal =
        std::hypot(sample.axes[0].value(), sample.axes[1].value(), sample.axes[2].value());
    const bool is_clean =
        !last_shaken_ || seconds_between(*last_shaken_, sample.time) > kReachSeconds;
    if (!is_clean || !std::isfinite(norm_mgal)) {
        ++now.left_out;
        return;
    }
    if (now.used++ == 0) now.zero_mgal = norm_mgal;
    now.sum_mgal += norm_mgal - now.zero_mgal;
    now.minute_sum_mgal += norm_mgal - now.zero_mgal;
    if (++now.in_minute < kPerMinute) return;
    const double mean = now.minute_sum_mgal / kPerMinute;
    now.minutes_sum += mean;
    now.minutes_square += mean * mean;
    ++now.minutes;
    now.minute_sum_mgal = 0.0;
    now.in_minute = 0;
}

RunningReading RunningValue::reading(MilliGal target, State state) const {
    RunningReading reading;
    std::vector<SetUp> usable;
    bool has_running = false;  // The last set-up is usable.
    for (const SetUp& one : set_ups_) {
        reading.used_s += kLiveStepSeconds * one.used;
        reading.left_out_s += kLiveStepSeconds * one.left_out;
        has_running = one.used > 0 && (usable.empty() || one.minutes > 0);
        if (has_running) usable.push_back(one);
    }
    if (usable.empty()) return reading;

    std::vector<double> means_mgal;
    double about_mean = 0.0, inverse = 0.0;  // Sum of squares; sum of 1 / u_i.
    int degrees = 0;
    for (const SetUp& one : usable) {
        means_mgal.push_back(one.zero_mgal + one.sum_mgal / one.used);
        inverse += 1.0 / (kLiveStepSeconds * one.used);
        if (one.minutes == 0) continue;
        about_mean +=
            std::max(0.0, one.minutes_square - one.minutes_sum * one.minutes_sum / one.minutes);
        degrees += one.minutes - 1;
    }
    const double count = static_cast<double>(usable.size());
    reading.set_ups = static_cast<int>(usable.size());
    reading.value = MilliGal(mean_of(means_mgal));
    if (usable.size() > 1) {
        const double sd = sd_of(means_mgal);
        reading.set_up_sd = MilliGal(sd);
        reading.set_up_sd_limits = limits_of_sd(sd, count - 1.0);
        reading.set_up_error = MilliGal(sd / std::sqrt(count));
    }
    if (degrees < kLeastDegrees) return reading;

    const double scatter = about_mean / degrees * kSecondsPerMinute;  // Divided by u below.
    const double cycle = options_.cycle_mgal / (2.0 * std::numbers::sqrt2);
    const double bend_s = options_.cycle_s / std::numbers::pi;
    const double length_s = count * count / inverse;
    const double share = std::min(1.0, bend_s / length_s);
    const double square = scatter / length_s + cycle * cycle * share * share;
    reading.standard_error = MilliGal(std::sqrt(square));
    if (state != State::stable) return reading;

    // scatter / u + (cycle bend / u)^2 = target^2
    const double wanted = target.value() * target.value();
    const double by_square = cycle * cycle * bend_s * bend_s;
    const double whole_s =
        (scatter + std::sqrt(scatter * scatter + 4.0 * wanted * by_square)) / (2.0 * wanted);
    const double last_s = kLiveStepSeconds * usable.back().used;
    const double last_inverse = count * count / whole_s - (inverse - 1.0 / last_s);
    reading.is_good_enough = square <= wanted;
    if (reading.is_good_enough)
        reading.needed_s = 0.0;
    else if (has_running && last_inverse > 0.0)
        reading.needed_s = std::max(0.0, 1.0 / last_inverse - last_s);
    return reading;
}

}  // namespace a351::daemon::verdict
