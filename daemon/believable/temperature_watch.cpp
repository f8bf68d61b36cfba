#include "daemon/believable/temperature_watch.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/believable/remedy.hpp"

namespace a351::daemon::believable {

namespace {

/// Returns the trouble of a conversion that does not fit.
text::Message conversion_trouble(const TemperatureFormat& own, const TemperatureCounts& counts,
                                 std::optional<DegC> oven,
                                 const std::vector<TemperatureFit>& fits) {
    const DegC temperature = own.temperature(counts);
    text::Message trouble;
    if (!is_temperature_believable(temperature)) {
        trouble = text::message(
            "the temperature reads {:.1f} degC, but the sensor can have only {:.0f} "
            "to {:+.0f} degC: its conversion does not fit this sensor",
            temperature.value(), kColdest.value(), kHottest.value());
    } else if (!own.is_possible(counts)) {
        trouble = text::message(
            "the temperature reads {:.2f} degC whatever the sensor sends: its "
            "conversion does not fit this sensor",
            temperature.value());
    } else {
        trouble = text::message(
            "the temperature reads {:.1f} degC in an oven of {:.1f} degC: its "
            "conversion does not fit this sensor",
            temperature.value(), oven->value());
    }
    for (const TemperatureFit& fit : fits) {
        const auto& formula = fit.format.formula;
        const double degc = fit.temperature.value();
        trouble =
            trouble + (&fit == &fits.front()
                           ? text::message("; its counts N fit {} degC, which gives {:.1f} degC",
                                           formula, degc)
                           : text::message(" or {} degC, which gives {:.1f} degC", formula, degc));
    }
    return trouble + identify();
}

}  // namespace

TemperatureWatch::TemperatureWatch(const wire::DeviceProfile& profile)
    : own_(format_of(profile)),
      frozen_after_s_(static_cast<int>(
          kFrozen_s * std::max(1.0, std::abs(profile.temperature_slope_degc) / kUsualStep_degc))) {}

void TemperatureWatch::take(const Second& second) {
    const Second::Range& range = second.channels[kTemperature];
    const TemperatureCounts counts{range.least, range.most, range.mean};
    if (answer_ && seconds_between(answer_->time, second.end) > kOldAnswer_s) answer_.reset();
    judge_conversion(second.end, counts);
    judge_oven(own_.temperature(counts));
    judge_life(range);
}

void TemperatureWatch::take_oven(UtcTime time, std::optional<DegC> oven, DegC set_point) {
    answer_.reset();
    if (oven) answer_ = {time, *oven, std::abs((*oven - set_point).value()) <= kAtSetPoint_degc};
}

void TemperatureWatch::judge_conversion(UtcTime now, const TemperatureCounts& counts) {
    if (counts.are_empty()) return;  // It is frozen.
    const Place place{now, own_.temperature(counts)};
    const std::optional<DegC> oven = answer_ ? std::optional(answer_->oven) : std::nullopt;
    const auto fits = fitting_formats(counts, own_, oven);
    const bool is_possible = own_.is_possible(counts);
    const bool fits_own = is_possible && fits[0].is_of_profile;
    const bool is_other_nearer = oven && !fits.empty() && !fits_own &&
                                 is_near_oven(fits[0].temperature, *oven) &&
                                 is_temperature_usual(fits[0].temperature);
    if (!is_other_nearer) far_.reset();
    if (is_other_nearer && !far_) far_ = place;
    if (is_possible && (!is_by_oven_ || fits_own)) conversion_.reset();
    const bool is_unfit = !is_possible || (is_other_nearer && !approaches(*oven, place));
    if (unfit_.take(is_unfit) && !conversion_) {
        conversion_ = conversion_trouble(own_, counts, oven, fits);
        is_by_oven_ = is_possible;
    }
}

/// Returns true if the sensor approaches the oven from far_ as a box does.
bool TemperatureWatch::approaches(DegC oven, const Place& now) const {
    const double distance_degc = (oven - now.temperature).value();
    const double approached_degc =
        std::copysign(1.0, distance_degc) * (now.temperature - far_->temperature).value();
    return approached_degc >=
           0.5 * std::abs(distance_degc) * seconds_between(far_->time, now.time) / kSlowestBox_s;
}

void TemperatureWatch::judge_oven(DegC temperature) {
    const bool is_still = std::abs((temperature - still_at_).value()) <= kMostStill_degc;
    if (!is_still) still_at_ = temperature;
    const bool is_known = answer_ && answer_->is_at_set_point;
    const bool is_near = is_known && is_near_oven(temperature, answer_->oven);
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
    if (conversion_) {
        troubles.push_back(*conversion_);
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
