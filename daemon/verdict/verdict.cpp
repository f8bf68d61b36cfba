#include "daemon/verdict/verdict.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "protocol/core/units.hpp"

namespace a351::daemon::verdict {
namespace {

using text::marked;

constexpr double kAheadHours = 600.0 / kSecondsPerHour;
constexpr double kWatchedHours = 1.0;  ///< Time in which a box that was switched on warms up.

/// Returns the seconds until the checks are met by waiting alone; std::nullopt if that is not
/// enough.
std::optional<double> waiting_time_s(std::span<const Reason> reasons) {
    double longest_s = 0.0;
    for (const Reason& reason : reasons) {
        if (reason.is_met) continue;
        const std::string_view unit = reason.unit;
        const double unit_s = unit == "s"     ? 1.0
                              : unit == "min" ? kSecondsPerMinute
                              : unit == "h"   ? kSecondsPerHour
                                              : 0.0;
        if (!reason.is_least || unit_s == 0.0) return std::nullopt;
        longest_s = std::max(longest_s, unit_s * (reason.limit - reason.value));
    }
    return longest_s;
}

}  // namespace

std::string_view to_text(State state) noexcept {
    // In the order of the enumerators.
    constexpr std::array kTexts{marked("no data"), marked("warming up"), marked("disturbed"),
                                marked("settling"), marked("stable")};
    return kTexts.at(static_cast<std::size_t>(state));
}

text::Message Reason::to_message() const {
    const std::string in_unit = *unit ? std::string(" ") + unit : "";
    text::Message measured =
        text::marked_message(quantity) +
        fmt::format(" {:.3g}{}{}{}", value, error > 0.0 ? fmt::format(" +- {:.2g}", error) : "",
                    in_unit, *ending ? " " : "");
    if (*ending) measured += text::marked_message(ending);
    const std::string at = fmt::format("{:.3g}{}", limit, in_unit);
    return measured +
           (is_least ? text::message(" (needs {})", at) : text::message(" (limit {})", at));
}

const Verdict& Judge::take(const LiveSample& sample) {
    const double x = sample.axes[0].value(), y = sample.axes[1].value(), z = sample.axes[2].value();
    const double degc = sample.temperature.value();
    const auto handled = touches_.last_handled();
    touches_.take(sample);
    trend_.take(sample.time, sample.temperature);
    if (touches_.last_handled() != handled) {
        trend_.touch();
        slope_.clear();
        steady_since_.reset();
        is_steady_ = false;
    }
    const double norm_mgal = std::hypot(x, y, z);
    if (std::isfinite(norm_mgal) && touches_.is_clean(sample))
        slope_.take(sample.time, MilliGal(norm_mgal));
    if (std::isfinite(degc)) {
        follow_power(sample.seen_at, degc);
        if (!stuck_since_ || degc != last_degc_) stuck_since_ = sample.seen_at;
        last_degc_ = degc;
    }
    if (std::isfinite(x + y + z + degc)) last_good_ = sample.seen_at;
    return at(sample.seen_at);
}

/// Detects power-on: a box that is cold at the first sample, or warms by itself, has just been
/// switched on.  One that became cold while there were no data was switched off.
void Judge::follow_power(UtcTime seen_at, double degc) {
    if (!first_seen_) {
        first_seen_ = seen_at;
        first_degc_ = degc;
    }
    const bool is_cold = degc < options_.operating_degc - options_.warm_up_degc;
    const bool has_warmed =
        degc > first_degc_ + 0.5 * options_.warm_up_degc &&
        seconds_between(*first_seen_, seen_at) < kWatchedHours * kSecondsPerHour;
    if (!switched_on_ && (is_cold || has_warmed)) switched_on_ = first_seen_;
    const bool has_cooled = is_cold && degc < last_degc_ - 0.5 * options_.warm_up_degc;
    if (has_cooled && last_good_ && seconds_between(*last_good_, seen_at) > options_.gap_s) {
        switched_on_ = seen_at;
        was_switched_off_ = true;
    }
}

const Verdict& Judge::at(UtcTime now) {
    std::vector<Reason> reasons;
    const auto check = [&](const Reason& reason) {
        reasons.push_back(reason);
        return reason.is_met;
    };
    const auto most = [&](const char* quantity, double value, const char* unit, double limit,
                          const char* ending = "") {
        return check({quantity, value, unit, ending, limit, false, value <= limit});
    };
    const auto least = [&](const char* quantity, double value, const char* unit, double limit,
                           const char* ending = "") {
        return check({quantity, value, unit, ending, limit, true, value >= limit});
    };
    const auto no_data = [&](Lack lack, UtcTime since) -> const Verdict& {
        verdict_.lack = lack;
        return decide(State::no_data, since, std::move(reasons));
    };
    if (!last_good_) {
        least(marked("values so far (the first takes 20 s):"), 0.0, "", 1.0);
        return no_data(Lack::values, now);
    }
    if (!most(marked("last good sample"), seconds_between(*last_good_, now), "s", options_.gap_s,
              marked("ago")))
        return no_data(Lack::values, *last_good_ + from_seconds(options_.gap_s));
    if (!most(marked("temperature unchanged for"), seconds_between(*stuck_since_, *last_good_), "s",
              options_.stuck_s))
        return no_data(Lack::changes, *stuck_since_ + from_seconds(options_.stuck_s));
    reasons.clear();

    const double off_degc = std::abs(last_degc_ - options_.operating_degc);
    bool is_warm = most(marked("temperature differs from the set point by"), off_degc, "degC",
                        options_.warm_up_degc);

    double on_h = options_.warm_up_h, warm_up_mgal = 0.0;
    if (switched_on_) {
        on_h = seconds_between(*switched_on_, now) / kSecondsPerHour;
        warm_up_mgal = options_.warm_up_mgal * std::exp(-on_h / options_.warm_up_h);
    }
    const double sure = is_steady_ ? options_.sure_stay : options_.sure;
    bool is_settled = false;
    if (const auto outlook = trend_.outlook(warm_up_mgal)) {
        const double change = std::abs(outlook->change_mgal), error = outlook->error_mgal;
        is_settled = check({marked("reading will change in 10 min by"), outlook->change_mgal,
                            "mGal", "", options_.change_mgal, false,
                            change + sure * error <= options_.change_mgal, error});
        is_settled &= most(marked("temperature slope"), std::abs(trend_.slope_degc_per_h()),
                           "degC/h", options_.slope_degc_per_h);
    } else {
        least(marked("temperature known for"), trend_.known_min(), "min", options_.history_min);
    }
    if (const auto& slope = slope_.slope()) {
        const double value = std::abs(slope->mgal_per_h), error = slope->error_mgal_per_h;
        const double limit = options_.change_mgal / kAheadHours;
        is_settled &= check({marked("acceleration slope"), value, "mGal/h", "", limit, false,
                             value - sure * error <= limit, error});
    }
    if (!is_settled && on_h < options_.warm_up_h)
        is_warm = least(was_switched_off_ ? marked("the box was switched off, and on again")
                                          : marked("switched on"),
                        on_h, "h", options_.warm_up_h, marked("ago"));

    const std::size_t thermal_count = reasons.size();
    bool is_quiet = true;
    const auto ago = [&](const char* event, std::optional<UtcTime> time, double limit_s) {
        if (time)
            is_quiet &= least(event, seconds_between(*time, now), "s", limit_s, marked("ago"));
    };
    ago(marked("last knock"), touches_.last_knock(), options_.quiet_s);
    ago(marked("box last touched"), touches_.last_handled(), options_.watch_s);
    ago(marked("last shaking"), touches_.last_shaking(), options_.shake_s);
    is_quiet &= most(marked("noise"), touches_.noise_ratio(), "", options_.noise_factor,
                     marked("x its usual level"));

    if (is_settled && is_warm) {
        if (!steady_since_) steady_since_ = now;
    } else {
        steady_since_.reset();
    }
    const double steady_s = steady_since_ ? seconds_between(*steady_since_, now) : 0.0;
    is_steady_ = steady_since_ && steady_s >= options_.hold_s;
    const std::span checks(reasons);
    const auto thermal_s = waiting_time_s(checks.first(thermal_count)),
               quiet_s = waiting_time_s(checks.subspan(thermal_count));
    std::optional<double> left_s;
    if (thermal_s && quiet_s)
        left_s = std::max(*thermal_s + std::max(0.0, options_.hold_s - steady_s), *quiet_s);
    if (!is_warm) return decide(State::warming_up, now, std::move(reasons), left_s);
    if (!is_quiet) {  // The disturbances come first.
        std::rotate(reasons.begin(), reasons.begin() + static_cast<std::ptrdiff_t>(thermal_count),
                    reasons.end());
        return decide(State::disturbed, now, std::move(reasons), left_s);
    }
    const auto state = is_steady_ ? State::stable : State::settling;
    return decide(state, now, std::move(reasons), left_s);
}

/// @param since  begin of the state, unless it lasts already
const Verdict& Judge::decide(State state, UtcTime since, std::vector<Reason> reasons,
                             std::optional<double> time_left_s) {
    std::ranges::stable_sort(reasons, {}, &Reason::is_met);
    if (state != verdict_.state || !has_judged_) verdict_.since = since;
    has_judged_ = true;
    verdict_.state = state;
    verdict_.reasons = std::move(reasons);
    verdict_.time_left_s = time_left_s;
    return verdict_;
}

}  // namespace a351::daemon::verdict
