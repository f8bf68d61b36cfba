#include "daemon/believable/axes_watch.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "daemon/believable/remedy.hpp"

namespace a351::daemon::believable {

AxesWatch::AxesWatch(const wire::DeviceProfile& profile)
    : g_per_count_(profile.acceleration(1).value()),
      most_g_(kMostOfRange * profile.rated_range.value()) {}

void AxesWatch::take(const Second& second) {
    judge_life(second);
    // A constant axis explains the norm.
    const auto axes = std::span(second.channels).first<kAxisCount>();
    const auto constant = std::ranges::count_if(axes, &Second::Range::is_constant);
    if (constant == 0 || constant == kAxisCount) {
        judge_scale(second);
    } else {
        wrong_.take(false);
        wrong_norm_.reset();
    }
}

void AxesWatch::judge_life(const Second& second) {
    const auto axes = std::span(second.channels).first<kAxisCount>();
    const bool does_one_move =
        std::ranges::any_of(axes, [](const Second::Range& axis) { return !axis.is_constant(); });
    for (std::size_t i = 0; i < kAxisCount; ++i) {
        const bool is_same = axes[i].is_constant() && axes[i].least == last_[i];
        is_dead_[i] = constant_[i].take(does_one_move && is_same);
        last_[i] = axes[i].most;
    }
}

void AxesWatch::judge_scale(const Second& second) {
    double square = 0.0, restlessness_g = 0.0, largest_g = 0.0;
    for (std::size_t i = 0; i < kAxisCount; ++i) {
        const Second::Range& axis = second.channels[i];
        const double mean_g = g_per_count_ * axis.mean;
        square += mean_g * mean_g;
        largest_g = std::max(largest_g, std::abs(mean_g));
        restlessness_g = std::max(
            restlessness_g, 0.5 * g_per_count_ * (static_cast<double>(axis.most) - axis.least));
    }
    const StandardGravity norm(std::sqrt(square));
    const bool is_at_rest =
        restlessness_g <= kMostRestlessness * std::max(norm, kLeastScale).value();
    const bool is_beyond_range = largest_g > most_g_;
    const bool is_believable = !is_beyond_range && is_norm_believable(norm);
    if (is_at_rest && is_believable) wrong_norm_.reset();
    const bool is_wrong = is_beyond_range || (is_at_rest && !is_believable);
    if (wrong_.take(is_wrong) && !wrong_norm_) wrong_norm_ = norm;
}

void AxesWatch::append_troubles(std::vector<text::Message>& troubles) const {
    for (std::size_t i = 0; i < kAxisCount; ++i) {
        if (!is_dead_[i]) continue;
        troubles.push_back(
            text::message("axis {} does not change while others do: it is dead, and gravity cannot "
                          "be computed; switch the sensor off and on",
                          "xyz"[i]) +
            or_identify());
    }
    if (wrong_norm_) {
        troubles.push_back(text::message("the acceleration reads {:.2f} g, but a box at rest has 1 "
                                         "g: the scale does not fit this sensor",
                                         wrong_norm_->value()) +
                           identify());
    }
}

}  // namespace a351::daemon::believable
