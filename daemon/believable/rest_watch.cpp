#include "daemon/believable/rest_watch.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "daemon/believable/at_rest.hpp"

namespace a351::daemon::believable {
namespace {

constexpr std::chrono::hours kNormKept{24};

/// Returns the name of a stance: "+z" if the axis z reads +1 g.
std::string name_of(std::size_t stance) { return {stance % 2 == 0 ? '+' : '-', "xyz"[stance / 2]}; }

}  // namespace

RestWatch::RestWatch(const wire::DeviceProfile& profile)
    : g_per_count_(profile.acceleration(1).value()) {}

std::optional<RestWatch::Stance> RestWatch::stance_of(const Second& second) const {
    const Motion motion = motion_of(second, g_per_count_);
    if (!motion.is_at_rest || !is_norm_believable(motion.norm)) return std::nullopt;
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
        const double share = g_per_count_ * second.channels[axis].mean / motion.norm.value();
        if (std::abs(share) >= kLeastVertical)
            return Stance{2 * axis + (share < 0.0 ? 1U : 0U), motion.norm};
    }
    return std::nullopt;
}

void RestWatch::take(const Second& second) {
    const auto now = stance_of(second);
    if (!now || now->number != stance_) interrupt();
    if (!now) return;
    stance_ = now->number;
    norms_g_ += now->norm.value();
    ++rested_s_;
    ++pasts_[*stance_].now_s;
    if (rested_s_ >= kStance_s) judge_stance();
    if (rested_s_ % kMinute_s != 0) return;
    judge_norm(second.end, StandardGravity(norms_g_ / kMinute_s));
    norms_g_ = 0.0;
}

void RestWatch::interrupt() {
    stance_.reset();
    rested_s_ = 0;
    norms_g_ = 0.0;
}

void RestWatch::end_of_history() {
    interrupt();
    for (Past& past : pasts_) past.before_s += std::exchange(past.now_s, 0);
    is_compared_ = false;
    strange_stance_.reset();
}

void RestWatch::judge_stance() {
    const auto is_known = [](const Past& past) { return past.before_s >= kStance_s; };
    if (is_known(pasts_[*stance_])) strange_stance_.reset();
    if (is_compared_) return;
    is_compared_ = true;
    if (!is_known(pasts_[*stance_]) && std::ranges::any_of(pasts_, is_known))
        strange_stance_ = stance_;
}

void RestWatch::judge_norm(UtcTime now, StandardGravity norm) {
    Past& past = pasts_[*stance_];
    const double change_g = past.norm ? (norm - *past.norm).value() : 0.0;
    const bool is_changed = std::abs(change_g) > kMostNormChange.value();
    if (changed_.take(is_changed) && !change_g_) change_g_ = change_g;
    if (is_changed) return;
    change_g_.reset();
    if (past.norm && now < past.norm_time + kNormKept) return;
    past.norm = norm;
    past.norm_time = now;
}

void RestWatch::append_troubles(std::vector<text::Message>& troubles) const {
    if (strange_stance_) {
        const auto usual = std::ranges::max_element(pasts_, {}, &Past::before_s) - pasts_.begin();
        troubles.push_back(text::message(
            "the vertical axis is {}, but before the start it was {}: axes are exchanged, or "
            "the box lies on its side; check sensor, box and sensor.profile; if the box was "
            "turned on purpose, start the recorder again",
            name_of(*strange_stance_), name_of(static_cast<std::size_t>(usual))));
    }
    if (change_g_) {
        troubles.push_back(text::message(
            "the acceleration at rest has changed by {:+.1f} mg within a day (limit {:.0f} "
            "mg): the scale or a bias of the sensor is not stable; read a benchmark of known "
            "gravity, and if it differs, use another sensor",
            1e3 * *change_g_, 1e3 * kMostNormChange.value()));
    }
}

}  // namespace a351::daemon::believable
