#include "daemon/believable/temperature_watch.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/believable/remedy.hpp"

namespace a351::daemon::believable {

TemperatureWatch::TemperatureWatch(const wire::DeviceProfile& profile)
    : slope_degc_(profile.temperature_slope_degc),
      offset_degc_(profile.temperature_offset_degc),
      frozen_after_s_(static_cast<int>(
          kFrozen_s * std::max(1.0, std::abs(profile.temperature_slope_degc) / kUsualStep_degc))) {}

void TemperatureWatch::take(const Second& second) {
    const Second::Range& counts = second.channels[kTemperature];
    const DegC temperature(slope_degc_ * counts.mean + offset_degc_);
    judge_range(temperature);
    judge_oven(second.end, temperature);
    judge_life(counts);
}

void TemperatureWatch::take_oven(UtcTime time, std::optional<DegC> oven, DegC set_point) {
    answer_.reset();
    if (oven) answer_ = {time, *oven, std::abs((*oven - set_point).value()) <= kAtSetPoint_degc};
}

void TemperatureWatch::judge_range(DegC temperature) {
    const bool is_outside = !is_temperature_believable(temperature);
    if (!is_outside) outside_degc_.reset();
    if (outside_.take(is_outside) && !outside_degc_) outside_degc_ = temperature;
}

void TemperatureWatch::judge_oven(UtcTime now, DegC temperature) {
    const auto distance_degc = [](DegC a, DegC b) { return std::abs((a - b).value()); };
    const bool is_still = distance_degc(temperature, still_at_) <= kMostStill_degc;
    if (!is_still) still_at_ = temperature;
    const bool is_known =
        answer_ && answer_->is_at_set_point && seconds_between(answer_->time, now) <= kOldAnswer_s;
    const bool is_near =
        is_known && distance_degc(temperature, answer_->oven) <= kMostFromOven_degc;
    if (is_near) off_degc_.reset();
    if (off_.take(is_known && !is_near && is_still) && !off_degc_) off_degc_ = temperature;
}

void TemperatureWatch::judge_life(const Second::Range& counts) {
    const bool is_same = counts.is_constant() && counts.least == last_;
    last_ = counts.most;
    if (!is_same) {
        if (!is_frozen_) longest_pause_s_ = std::max(longest_pause_s_, equal_s_);
        equal_s_ = 0;
    } else {
        ++equal_s_;
    }
    is_frozen_ = equal_s_ >= std::max(frozen_after_s_, kFrozenPauses * longest_pause_s_);
}

void TemperatureWatch::append_troubles(std::vector<text::Message>& troubles) const {
    if (outside_degc_) {
        troubles.push_back(
            text::message("the temperature reads {:.1f} degC, but the sensor can have only {:.0f} "
                          "to {:+.0f} degC: its conversion does not fit this sensor",
                          outside_degc_->value(), kColdest.value(), kHottest.value()) +
            identify());
    } else if (off_degc_) {
        troubles.push_back(
            text::message("the temperature reads {:.1f} degC and does not follow the oven, which "
                          "is at its set point: readings cannot be corrected for temperature; "
                          "check that the sensor is in the oven",
                          off_degc_->value()) +
            or_identify());
    }
    if (is_frozen_) {
        troubles.push_back(
            text::message(
                "the temperature has not changed for {:.0f} min: it is frozen, and "
                "readings cannot be corrected for it; switch the sensor off and on",
                std::max(frozen_after_s_, kFrozenPauses * longest_pause_s_) / kSecondsPerMinute) +
            or_identify());
    }
}

}  // namespace a351::daemon::believable
