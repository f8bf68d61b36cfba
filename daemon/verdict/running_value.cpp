#include "daemon/verdict/running_value.hpp"

#include <cmath>

#include "protocol/core/units.hpp"
#include "protocol/signal/distributions.hpp"
#include "protocol/signal/moments.hpp"

namespace a351::daemon::verdict {
namespace {

constexpr int kPerMinute = 30;  // samples

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
}

RunningReading RunningValue::reading() const {
    RunningReading reading;
    std::vector<double> means_mgal;
    for (const SetUp& one : set_ups_) {
        reading.used_s += kLiveStepSeconds * one.used;
        reading.left_out_s += kLiveStepSeconds * one.left_out;
        if (one.used >= (means_mgal.empty() ? 1 : kPerMinute))
            means_mgal.push_back(one.zero_mgal + one.sum_mgal / one.used);
    }
    if (means_mgal.empty()) return reading;
    reading.set_ups = static_cast<int>(means_mgal.size());
    reading.value = MilliGal(signal::mean_of(means_mgal));
    if (means_mgal.size() < 2) return reading;
    const double sd = signal::sample_sd_of(means_mgal), count = reading.set_ups;
    reading.set_up_sd = MilliGal(sd);
    reading.set_up_sd_limits = limits_of_sd(sd, count - 1.0);
    reading.set_up_error = MilliGal(sd / std::sqrt(count));
    return reading;
}

}  // namespace a351::daemon::verdict
