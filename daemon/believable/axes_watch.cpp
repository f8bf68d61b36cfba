#include "daemon/believable/axes_watch.hpp"

#include <algorithm>
#include <functional>
#include <span>

#include "daemon/believable/at_rest.hpp"
#include "daemon/believable/remedy.hpp"

namespace a351::daemon::believable {

AxesWatch::AxesWatch(const wire::DeviceProfile& profile)
    : g_per_count_(profile.acceleration(1).value()),
      most_g_(kMostOfRange * profile.rated_range.value()) {}

void AxesWatch::take(const Second& second) {
    judge_life(second);
    const auto axes = std::span(second.channels).first<kAxisCount>();
    is_exchanged_ |= exchanged_.take(std::ranges::any_of(axes, [](const Second::Range& axis) {
        return std::ranges::max(axis.byte_changes) > axis.byte_changes[0] + kMostByteExcess;
    }));
    // A constant axis, or another order of the bytes, explains the norm.
    if (!is_exchanged_ && std::ranges::none_of(axes, &Second::Range::is_constant)) {
        judge_scale(second);
    } else {
        wrong_.take(false);
        wrong_norm_.reset();
    }
}

void AxesWatch::judge_life(const Second& second) {
    for (std::size_t i = 0; i < kAxisCount; ++i)
        is_dead_[i] = constant_[i].take(second.channels[i].is_constant());
}

void AxesWatch::judge_scale(const Second& second) {
    const Motion motion = motion_of(second, g_per_count_);
    const bool is_beyond_range = motion.largest_g > most_g_;
    const bool is_believable = !is_beyond_range && is_norm_believable(motion.norm);
    if (motion.is_at_rest && is_believable) wrong_norm_.reset();
    const bool is_wrong = is_beyond_range || (motion.is_at_rest && !is_believable);
    if (wrong_.take(is_wrong) && !wrong_norm_) wrong_norm_ = motion.norm;
}

void AxesWatch::append_troubles(std::vector<text::Message>& troubles) const {
    const bool are_all_dead = std::ranges::all_of(is_dead_, std::identity());
    if (are_all_dead) {
        troubles.push_back(
            text::message("no axis changes any more: the sensor repeats its values, and gravity "
                          "cannot be computed; switch the sensor off and on") +
            or_identify());
    }
    for (std::size_t i = 0; i < kAxisCount && !are_all_dead; ++i) {
        if (!is_dead_[i]) continue;
        troubles.push_back(
            text::message("axis {} does not change while others do: it is dead, and gravity cannot "
                          "be computed; switch the sensor off and on",
                          "xyz"[i]) +
            or_identify());
    }
    if (is_exchanged_) {
        troubles.push_back(
            text::message("the lowest byte of an axis changes less often than a higher one: "
                          "the sensor sends its bytes in another order, and the acceleration is "
                          "wrong") +
            identify());
    }
    if (wrong_norm_) {
        troubles.push_back(text::message("the acceleration reads {:.2f} g, but a box at rest has 1 "
                                         "g: the scale does not fit this sensor",
                                         wrong_norm_->value()) +
                           identify());
    }
}

}  // namespace a351::daemon::believable
