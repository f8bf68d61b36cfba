#include "daemon/verdict/temperature_trend.hpp"

#include <algorithm>
#include <cmath>

namespace a351::daemon::verdict {
namespace {

constexpr double kMeanSeconds = OvenFilter::kStepSeconds;
constexpr double kLongestGapSeconds = 300.0;  ///< Longest gap to fill: a third of a cycle.
constexpr double kVarianceShare = 0.05;   ///< Weight of a new variance: averages about 20 means.
constexpr double kLeastErrorDegc = 3e-4;  ///< Least error of a mean: the sensor's noise.

}  // namespace

void TemperatureTrend::take(UtcTime time, DegC temperature) {
    const double degc = temperature.value();
    if (!std::isfinite(degc)) return;
    if (count_ > 0 && time > last_ && seconds_between(begun_, time) >= kMeanSeconds) {
        close_mean();
        begun_ += from_seconds(kMeanSeconds);
    }
    if (time <= last_ || seconds_between(last_, time) > kLongestGapSeconds) {
        means_ = count_ = 0;
        sum_degc_ = squares_degc2_ = 0.0;
        begun_ = time - time.time_since_epoch() % from_seconds(kMeanSeconds);
    }
    while (seconds_between(begun_, time) >= kMeanSeconds) {  // Fills a gap.
        filter_.step();
        reading_.take(OvenFilter::seen(filter_.state()));
        ++means_;
        begun_ += from_seconds(kMeanSeconds);
    }
    if (count_ > 0) squares_degc2_ += (degc - last_degc_) * (degc - last_degc_);
    sum_degc_ += degc;
    ++count_;
    last_degc_ = degc;
    last_ = time;
}

void TemperatureTrend::close_mean() {
    const double mean = sum_degc_ / count_;
    if (count_ > 1) {
        const double variance = squares_degc2_ / (2.0 * (count_ - 1));
        variance_degc2_ += (means_ == 0 ? 1.0 : kVarianceShare) * (variance - variance_degc2_);
    }
    if (means_++ == 0) {
        filter_.begin(mean);
        reading_.clear();
    } else {
        filter_.step();
    }
    filter_.see(mean, std::max(kLeastErrorDegc, std::sqrt(variance_degc2_ / count_)));
    reading_.take(mean);
    sum_degc_ = squares_degc2_ = 0.0;
    count_ = 0;
}

double TemperatureTrend::known_min() const noexcept { return means_ * kMeanSeconds / 60.0; }

std::optional<Outlook> TemperatureTrend::outlook(double warm_up_mgal) const {
    if (known_min() < options_.history_min) return std::nullopt;
    return reading_.outlook(filter_, warm_up_mgal);
}

double TemperatureTrend::slope_degc_per_h() const noexcept {
    return filter_.off_level_degc() / (60.0 * options_.relax_min) * kSecondsPerHour;
}

}  // namespace a351::daemon::verdict
