#include "daemon/verdict/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace a351::daemon {
namespace {

constexpr double kSecondsPerHour = 3600.0;
constexpr double kAheadHours = 600.0 / kSecondsPerHour;

}  // namespace

std::string_view to_text(VerdictState state) noexcept {
    switch (state) {
        case VerdictState::no_data:
            return "no data";
        case VerdictState::warming_up:
            return "warming up";
        case VerdictState::disturbed:
            return "disturbed";
        case VerdictState::settling:
            return "settling";
        case VerdictState::stable:
            return "stable";
    }
    return "no data";
}

std::string Reason::to_text() const {
    char text[160];
    std::snprintf(text, sizeof text, "%s %.3g%s%s, %s %.3g", quantity, value, *unit ? " " : "",
                  unit, is_least ? "at least" : "limit", limit);
    return text;
}

VerdictJudge::VerdictJudge(const VerdictOptions& options)
    : options_(options), trend_(options), touches_(options) {}

const Verdict& VerdictJudge::take(const LiveSample& sample) {
    const double degc = sample.temperature.value();
    touches_.take(sample);
    trend_.take(sample.time, sample.temperature);
    const double sum = sample.axes[0].value() + sample.axes[1].value() + sample.axes[2].value();
    if (std::isfinite(sum + degc)) last_good_ = sample.seen_at;
    if (!std::isfinite(degc)) return at(sample.seen_at);
    if (!stuck_since_ || degc != last_degc_) stuck_since_ = sample.seen_at;
    last_degc_ = degc;
    // A box that is cold when it is first seen has just been switched on.
    if (!first_seen_) first_seen_ = sample.seen_at;
    if (!switched_on_ && degc < options_.operating_degc - options_.warm_up_degc) {
        switched_on_ = first_seen_;
    }
    return at(sample.seen_at);
}

const Verdict& VerdictJudge::at(UtcTime now) {
    judge(now);
    return verdict_;
}

void VerdictJudge::judge(UtcTime now) {
    std::vector<Reason> reasons;
    const auto most = [&](const char* quantity, double value, const char* unit, double limit) {
        reasons.push_back({quantity, value, unit, limit, false, value <= limit});
        return reasons.back().is_met;
    };
    const auto least = [&](const char* quantity, double value, const char* unit, double limit) {
        reasons.push_back({quantity, value, unit, limit, true, value >= limit});
        return reasons.back().is_met;
    };
    if (!last_good_) {
        least("good samples so far", 0.0, "", 1.0);
        return decide(VerdictState::no_data, now, std::move(reasons));
    }
    if (!most("last good sample", seconds_between(*last_good_, now), "s ago", options_.gap_s) ||
        !most("temperature the same for", seconds_between(*stuck_since_, now), "s",
              options_.stuck_s)) {
        return decide(VerdictState::no_data, now, std::move(reasons));
    }
    reasons.clear();

    const double share = verdict_.state == VerdictState::stable ? 1.0 : options_.enter_share;
    const double off_degc = std::abs(last_degc_ - options_.operating_degc);
    bool is_warm = most("temperature off the set point", off_degc, "degC", options_.warm_up_degc);

    bool is_settled = false;
    const auto& outlook = trend_.outlook();
    double change_mgal = outlook ? outlook->change_mgal : 0.0;
    if (switched_on_) {
        const double on_h = seconds_between(*switched_on_, now) / kSecondsPerHour;
        const double warm_up = options_.warm_up_mgal * std::exp(-on_h / options_.warm_up_h) *
                               std::expm1(-kAheadHours / options_.warm_up_h);
        change_mgal += warm_up;
        if (std::abs(change_mgal) > share * options_.change_mgal) {
            is_warm = least("since power-on", on_h, "h", options_.warm_up_h) && is_warm;
        }
    }
    if (!outlook) {
        least("temperature known for", trend_.known_min(), "min", options_.history_min);
    } else {
        is_settled = most("temperature slope", std::abs(outlook->slope_degc_per_h), "degC/h",
                          share * options_.slope_degc_per_h);
        is_settled &= most("reading changes in 10 min by", std::abs(change_mgal), "mGal",
                           share * options_.change_mgal);
        is_settled &= most("temperature bends by", 1000.0 * std::abs(outlook->bend_degc), "mdegC",
                           1000.0 * share * options_.bend_degc);
    }

    bool is_quiet = true;
    if (const auto knock = touches_.last_knock()) {
        is_quiet &=
            least("since the last knock", seconds_between(*knock, now), "s", options_.quiet_s);
    }
    if (const auto handled = touches_.last_handled()) {
        is_quiet &=
            least("since a hand at the box", seconds_between(*handled, now), "s", options_.watch_s);
    }
    is_quiet &= most("noise to its usual level", touches_.noise_ratio(), "", options_.noise_factor);

    if (is_settled && is_warm) {
        if (!steady_since_) steady_since_ = now;
    } else {
        steady_since_.reset();
    }
    if (!is_warm) return decide(VerdictState::warming_up, now, std::move(reasons));
    if (!is_quiet) return decide(VerdictState::disturbed, now, std::move(reasons));
    const bool is_steady = steady_since_ && seconds_between(*steady_since_, now) >= options_.hold_s;
    decide(is_steady ? VerdictState::stable : VerdictState::settling, now, std::move(reasons));
}

void VerdictJudge::decide(VerdictState state, UtcTime now, std::vector<Reason> reasons) {
    std::stable_sort(reasons.begin(), reasons.end(),
                     [](const Reason& a, const Reason& b) { return a.is_met < b.is_met; });
    if (state != verdict_.state || !has_judged_) verdict_.since = now;
    has_judged_ = true;
    verdict_.state = state;
    verdict_.reasons = std::move(reasons);
}

}  // namespace a351::daemon
