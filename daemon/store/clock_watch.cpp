#include "daemon/store/clock_watch.hpp"

#include <chrono>
#include <utility>

#include "protocol/timing/host_clock_rules.hpp"

namespace a351::daemon::store {

std::optional<status::ClockStep> ClockWatch::observe(const timing::ClockReading& reading) {
    if (last_ && reading.raw <= last_->raw) return std::nullopt;
    if (last_) {
        const Nanoseconds asleep =
            (reading.boottime - last_->boottime) - (reading.raw - last_->raw);
        if (asleep > timing::kShortestSleep) {
            slept_ += asleep;
            mapping_.woke_up();
        }
    }
    const auto before = std::exchange(last_, reading);
    timing::ClockReading awake = reading;
    awake.raw += slept_;
    const auto step = mapping_.observe(awake);
    if (!step) return std::nullopt;
    constexpr std::chrono::milliseconds kLeapSecond{1000}, kTolerance{100};
    const bool is_leap = before && before->leap != timing::LeapSecond::none &&
                         std::chrono::abs(std::chrono::abs(*step) - kLeapSecond) < kTolerance;
    if (is_leap) return std::nullopt;
    return status::ClockStep{reading.realtime - *step, reading.realtime};
}

}  // namespace a351::daemon::store
