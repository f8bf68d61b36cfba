#include "protocol/timing/utc_mapping.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/timing/host_clock_rules.hpp"

namespace a351::timing {
namespace {

using std::chrono::abs;
using std::chrono::microseconds;
using std::chrono::seconds;

constexpr Nanoseconds kTrustedAfter = seconds(60);  // after a step, and after waking up
constexpr Nanoseconds kSlopeOver = seconds(3);      // a reading is accurate to microseconds

}  // namespace

std::optional<Nanoseconds> UtcMapping::observe(const ClockReading& reading) {
    const Nanoseconds offset = reading.realtime.time_since_epoch() - reading.raw.time_since_epoch();
    const bool slept = std::exchange(has_slept_, false);
    if (slept) awake_since_ = reading.raw;
    if (reading.leap != LeapSecond::none) leap_at_ = announced_midnight(reading.realtime);
    if (!last_) {
        follow(reading, offset);
        return std::nullopt;
    }
    // While the host slept, one clock kept both UTC and boottime, so their offset did not drift.
    const Nanoseconds departure = offset - (slept ? recent_.back().offset : offset_at(reading.raw));
    const Nanoseconds slewed =
        doubted_ || slept ? Nanoseconds(0) : most_slewed(reading.raw - last_->raw);
    if (abs(departure) <= kClockStep + slewed) {
        doubted_.reset();
        follow(reading, offset);
        return std::nullopt;
    }
    if (!doubted_ && !slept && is_leap(reading, departure)) {
        recent_.clear();
        follow(reading, offset);
        return departure;
    }
    if (!doubted_ || abs(offset - doubted_->offset) > kClockStep) doubted_ = {reading.raw, offset};
    doubted_->offset = offset;
    if (!reading.is_synchronised && last_synchronised_) {
        doubted_->raw = reading.raw;
        return std::nullopt;
    }
    const bool is_first =
        reading.is_synchronised && !last_synchronised_ && !is_just_awake(reading.raw);
    if (!is_first && reading.raw - doubted_->raw < kTrustedAfter) return std::nullopt;
    doubted_.reset();
    recent_.clear();
    follow(reading, offset);
    return departure;
}

/// Returns true if the last reading announced the leap second that `departure` shows.
bool UtcMapping::is_leap(const ClockReading& reading, Nanoseconds departure) const noexcept {
    if (last_->leap == LeapSecond::none || abs(reading.realtime - *leap_at_) > kLeapDoubt)
        return false;
    const Nanoseconds step = seconds(last_->leap == LeapSecond::inserted ? -1 : 1);
    return abs(departure - step) <= kClockStep;
}

void UtcMapping::follow(const ClockReading& reading, Nanoseconds offset) {
    last_ = reading;
    if (reading.is_synchronised) last_synchronised_ = reading;
    recent_.push_back({reading.raw, offset});
    while (recent_.size() > 2 && reading.raw - recent_[1].raw >= kSlopeOver) recent_.pop_front();
}

double UtcMapping::slope() const {
    const Pair& last = recent_.back();
    const Nanoseconds over = last.raw - recent_.front().raw;
    if (over <= Nanoseconds(0)) return 0.0;
    const auto slope = static_cast<double>((last.offset - recent_.front().offset).count()) /
                       static_cast<double>(over.count());
    const double most = doubted_ ? kHostRateError : 1e-6 * static_cast<double>(kMostSlew_ppm);
    return std::clamp(slope, -most, most);
}

Nanoseconds UtcMapping::offset_at(RawTime raw) const {
    const Pair& last = recent_.back();
    return last.offset +
           from_seconds(slope() * std::chrono::duration<double>(raw - last.raw).count());
}

UtcTime UtcMapping::at(RawTime raw) const {
    return UtcTime(raw.time_since_epoch() + offset_at(raw));
}

bool UtcMapping::is_just_awake(RawTime raw) const noexcept {
    return awake_since_ && raw - *awake_since_ < kTrustedAfter;
}

bool UtcMapping::is_synchronised() const noexcept {
    return last_ && last_->is_synchronised && !doubted_ && !is_just_awake(last_->raw);
}

bool UtcMapping::is_held() const noexcept { return last_synchronised_ && !is_synchronised(); }

Nanoseconds UtcMapping::error_at(RawTime raw) const {
    const auto error = [&](const ClockReading& reading, Nanoseconds at_least) {
        const Nanoseconds since = std::max(raw - reading.raw, Nanoseconds(0));
        const Nanoseconds carried = std::max(raw - recent_.back().raw, Nanoseconds(0));
        return std::max<Nanoseconds>(microseconds(reading.max_error_us), at_least) +
               host_drift(since) +
               from_seconds(std::abs(slope()) * std::chrono::duration<double>(carried).count());
    };
    if (!last_synchronised_ || is_just_awake(last_->raw)) return error(*last_, kUnknownClockError);
    const bool is_near_leap = leap_at_ && abs(at(raw) - *leap_at_) <= kLeapDoubt;
    return error(*last_synchronised_, is_near_leap ? kUnknownClockError : Nanoseconds(0));
}

}  // namespace a351::timing
