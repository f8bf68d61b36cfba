#include "daemon/live/live_record.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "protocol/oven/controller_values.hpp"
#include "protocol/signal/median.hpp"

namespace a351::daemon::live {
namespace {

constexpr int kRecentSeconds = 90;  // The page shows 60.
// Least number of samples: a quarter of a second at the fastest simulated time.  The page reads
// them every tenth of a second.
constexpr int kLeastRecent = 50'000 / 4;
constexpr std::size_t kLevelSeconds = 2;  // Traffic of 20 mGal changes the tilt by 0.1' or less.
constexpr Nanoseconds kOvenStep = std::chrono::seconds(2);
/// Sample intervals from one sample to the next above which one is missing between them.
constexpr double kMostIntervals = 1.5;

constexpr double kArcminPerRadian = 60.0 * 180.0 / std::numbers::pi;

double elevation_arcmin(StandardGravity reading) {
    return kArcminPerRadian * std::asin(std::clamp(reading.value(), -1.0, 1.0));
}

template <class Point>
void keep_a_day(std::deque<Point>& points) {
    while (points.front().time < points.back().time - kHistoryKept) points.pop_front();
}

}  // namespace

std::optional<OvenPoint> oven_point(const journal::OvenChunk& poll, UtcTime time) {
    const auto values = oven::controller_values(poll.registers, poll.decimals);
    if (!values) return std::nullopt;
    return OvenPoint{time, values->process_value, values->set_point, poll.place};
}

Record::Record(const wire::DeviceProfile& profile, int rate_hz, const verdict::Options& options)
    : profile_(profile),
      rate_hz_(rate_hz),
      options_(options),
      recent_(static_cast<std::size_t>(std::max(kRecentSeconds * rate_hz, kLeastRecent)),
              1.0 / rate_hz),
      thinning_(profile, rate_hz),
      judge_(options),
      watch_(profile, rate_hz) {}

void Record::take(const PlacedSample& sample) {
    const std::lock_guard lock(mutex_);
    if (history_end_) {
        if (sample.time < *history_end_ + from_seconds(0.5 / rate_hz_)) return;
        history_end_.reset();
    }
    if (last_ && sample.time <= *last_) forget_from(sample.time);
    const bool is_after_gap =
        last_ && seconds_between(*last_, sample.time) > kMostIntervals / rate_hz_;
    if (is_after_gap) {
        gaps_.push_back({*last_ + from_seconds(1.0 / rate_hz_), sample.time});
        keep_a_day(gaps_);
    }
    // After a long gap there is "no data" until the filters are full, and at the begin.
    if (!last_ || is_after_gap) {
        judge_.at(sample.time);
        note_state();
    }
    last_ = sample.time;
    recent_.take(sample);
    watch_.take(sample.time, sample.counts);
    std::array<float, kLiveChannelCount> values{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        values[axis] = static_cast<float>(1e3 * profile_.acceleration(sample.counts[axis]).value());
    values[3] = static_cast<float>(profile_.temperature(sample.counts[3]).value());
    history_.take(sample.time, values);

    fresh_.clear();
    thinning_.take(sample, fresh_);
    for (const verdict::LiveSample& one : fresh_) {
        thinned_.push_back(one);
        keep_a_day(thinned_);
        judge_.take(one);
        note_state();
    }
}

void Record::note_state() {
    const verdict::Verdict& verdict = judge_.verdict();
    if (!states_.empty() && states_.back().state == verdict.state) return;
    states_.push_back({verdict.since, verdict.state});
    // The first one still holds until the second.
    while (states_.size() > 1 && states_[1].time < verdict.since - kHistoryKept)
        states_.pop_front();
}

void Record::end_of_history() {
    const std::lock_guard lock(mutex_);
    history_end_ = last_;
    watch_.end_of_history();
}

void Record::begin_unit(UtcTime last) {
    const std::lock_guard lock(mutex_);
    if (!thinned_.empty() && last < thinned_.front().time) return;  // The history begins later.
    std::erase_if(thinned_, [&](const auto& sample) { return sample.time <= last; });
    thinning_.begin_run();
    watch_.forget();
    judge_again();
}

/// Removes the series from `time` on, and judges the rest again.
void Record::forget_from(UtcTime time) {
    while (!gaps_.empty() && gaps_.back().time >= time) gaps_.pop_back();
    if (thinned_.empty() || thinned_.back().time < time) return;
    while (!thinned_.empty() && thinned_.back().time >= time) thinned_.pop_back();
    judge_again();
}

void Record::judge_again() {
    judge_ = verdict::Judge(options_);
    states_.clear();
    for (const verdict::LiveSample& sample : thinned_) {
        judge_.take(sample);
        note_state();
    }
}

void Record::take(const OvenPoint& point) {
    const std::lock_guard lock(mutex_);
    if (point.place == journal::OvenPlace::inner)
        watch_.take_oven(point.time, point.process_value, point.set_point);
    std::deque<OvenPoint>& points = ovens_.at(static_cast<std::size_t>(point.place));
    while (!points.empty() && points.back().time > point.time) points.pop_back();
    if (!points.empty() && point.time - points.back().time < kOvenStep) return;
    points.push_back(point);
    keep_a_day(points);
}

std::uint64_t Record::end() const {
    const std::lock_guard lock(mutex_);
    return recent_.end();
}

std::optional<Block> Record::block_from(std::uint64_t& cursor, std::size_t most) const {
    const std::lock_guard lock(mutex_);
    return recent_.block_from(cursor, most);
}

std::vector<Envelope> Record::history(Channel channel, UtcTime from, UtcTime to,
                                      std::size_t points) const {
    const std::lock_guard lock(mutex_);
    return history_.envelopes(channel, from, to, points);
}

std::vector<OvenPoint> Record::oven_history(journal::OvenPlace place, UtcTime from, UtcTime to,
                                            std::size_t points) const {
    const std::lock_guard lock(mutex_);
    std::vector<OvenPoint> found;
    for (const OvenPoint& point : ovens_.at(static_cast<std::size_t>(place)))
        if (point.time >= from && point.time < to) found.push_back(point);
    const std::size_t step = found.size() / std::max<std::size_t>(points, 1) + 1;
    for (std::size_t i = 0; i * step < found.size(); ++i) found[i] = found[i * step];
    found.resize((found.size() + step - 1) / step);
    return found;
}

void Record::judge_by(const verdict::Options& options) {
    const std::lock_guard lock(mutex_);
    if (options == options_) return;
    options_ = options;
    judge_again();
}

verdict::Verdict Record::verdict() const {
    const std::lock_guard lock(mutex_);
    return judge_.verdict();
}

verdict::State Record::state_at(UtcTime time) const {
    const std::lock_guard lock(mutex_);
    const auto next = std::ranges::upper_bound(states_, time, {}, &Since::time);
    return next == states_.begin() ? verdict::State::no_data : std::prev(next)->state;
}

std::optional<UtcTime> Record::last_sample() const {
    const std::lock_guard lock(mutex_);
    return last_;
}

std::vector<text::Message> Record::troubles() const {
    const std::lock_guard lock(mutex_);
    return watch_.troubles();
}

verdict::RunningReading Record::reading(std::span<const events::Occupation::SetUp> set_ups) const {
    const std::lock_guard lock(mutex_);
    verdict::RunningValue value(options_);
    for (const auto& [from, to, face] : set_ups) {
        value.begin_set_up(from);
        auto one = std::ranges::lower_bound(thinned_, from, {}, &verdict::LiveSample::time);
        for (; one != thinned_.end() && seconds_between(one->time, to) >= verdict::kReachSeconds;
             ++one)
            value.take(*one);
    }
    return value.reading();
}

double Record::missing_s(UtcTime from, UtcTime to) const {
    const std::lock_guard lock(mutex_);
    double missing = 0.0;
    for (const Gap& gap : gaps_) {
        const UtcTime first = std::max(gap.from, from), next = std::min(gap.time, to);
        if (first < next) missing += seconds_between(first, next);
    }
    return missing;
}

std::vector<signal::MotionSample> Record::motion(UtcTime from, UtcTime to) const {
    // The shaking of a sample is that of the 2 s before it was seen, kReachSeconds after its time.
    constexpr auto kLag =
        static_cast<std::size_t>(verdict::kReachSeconds / verdict::kLiveStepSeconds);
    const std::lock_guard lock(mutex_);
    std::vector<signal::MotionSample> samples;
    const auto first = std::ranges::lower_bound(thinned_, from, {}, &verdict::LiveSample::time);
    for (auto one = first; one != thinned_.end() && one->time < to; ++one) {
        const bool is_known = one - thinned_.begin() >= static_cast<std::ptrdiff_t>(kLag);
        samples.push_back({one->time, one->axes, is_known ? (one - kLag)->shake : MilliGal(0.0)});
    }
    return samples;
}

std::optional<Level> Record::level_against(UtcTime from, UtcTime to) const {
    const std::lock_guard lock(mutex_);
    constexpr std::size_t kAxes = 3;
    std::array<std::vector<double>, kAxes> stood_mgal;
    for (const verdict::LiveSample& sample : thinned_) {
        // Data from before the set-up must not reach in through the filters.
        if (seconds_between(from, sample.time) < verdict::kReachSeconds) continue;
        if (seconds_between(sample.time, to) < verdict::kReachSeconds) break;
        for (std::size_t axis = 0; axis < kAxes; ++axis)
            if (const double mgal = sample.axes[axis].value(); std::isfinite(mgal))
                stood_mgal[axis].push_back(mgal);
    }
    const auto now = recent_.mean_of_last(kLevelSeconds * static_cast<std::size_t>(rate_hz_));
    if (!now || std::ranges::any_of(stood_mgal, &std::vector<double>::empty)) return std::nullopt;
    std::array<double, kAxes> reference_mgal{};
    for (std::size_t axis = 0; axis < kAxes; ++axis)
        reference_mgal[axis] = signal::median(std::move(stood_mgal[axis]));
    const auto vertical = static_cast<std::size_t>(
        std::ranges::max_element(reference_mgal, {}, [](double mgal) { return std::abs(mgal); }) -
        reference_mgal.begin());
    Level level;
    const double g_per_count = profile_.acceleration(1).value();
    std::size_t place = 0;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
        if (axis == vertical) continue;
        const double tilt = elevation_arcmin(StandardGravity(g_per_count * (*now)[axis])) -
                            elevation_arcmin(to_standard_gravity(MilliGal(reference_mgal[axis])));
        const char letter = "xyz"[axis];
        level.axes[place] = letter;
        level.tilt_arcmin[place++] = tilt;
        if (std::abs(tilt) <= kMostTiltArcmin) continue;
        level.is_within = false;
        level.advice.push_back(
            tilt > 0.0 ? text::message("lower the +{} side by {:.1f}'", letter, std::abs(tilt))
                       : text::message("raise the +{} side by {:.1f}'", letter, std::abs(tilt)));
    }
    return level;
}

}  // namespace a351::daemon::live
