#include "daemon/source/host_clock.hpp"

#include <sys/timex.h>

#include <ctime>
#include <fstream>

namespace a351::daemon::source {
namespace {

Nanoseconds read_clock(clockid_t id) {
    timespec time{};
    clock_gettime(id, &time);
    return std::chrono::seconds(time.tv_sec) + Nanoseconds(time.tv_nsec);
}

}  // namespace

UtcTime host_realtime() { return UtcTime(read_clock(CLOCK_REALTIME)); }

UtcTime HostClock::now() const {
    return scale_ ? scale_->simulated(host_realtime()) : host_realtime();
}

RawTime HostClock::raw() const {
    if (scale_) return RawTime(now().time_since_epoch());
    return RawTime(read_clock(CLOCK_MONOTONIC_RAW));
}

Nanoseconds HostClock::slept() const {
    if (scale_) return Nanoseconds(0);
    const Nanoseconds raw = read_clock(CLOCK_MONOTONIC_RAW);
    return read_clock(CLOCK_BOOTTIME) - raw;
}

timing::ClockReading HostClock::read() const {
    timing::ClockReading reading;
    if (scale_) {
        reading.realtime = now();
        reading.raw = RawTime(reading.realtime.time_since_epoch());
        reading.boottime = reading.realtime.time_since_epoch();
        reading.is_synchronised = true;
        return reading;
    }
    // Read first, so that a reading across the midnight of a leap second still announces it.
    timex kernel{};
    const int state = adjtimex(&kernel);
    constexpr int kBrackets = 5;
    auto narrowest = Nanoseconds::max();
    for (int i = 0; i < kBrackets; ++i) {
        const Nanoseconds before = read_clock(CLOCK_MONOTONIC_RAW);
        const Nanoseconds realtime = read_clock(CLOCK_REALTIME);
        const Nanoseconds boottime = read_clock(CLOCK_BOOTTIME);
        const Nanoseconds width = read_clock(CLOCK_MONOTONIC_RAW) - before;
        if (width >= narrowest) continue;
        narrowest = width;
        reading.raw = RawTime(before + width / 2);
        reading.realtime = UtcTime(realtime);
        reading.boottime = boottime;
    }
    reading.is_synchronised =
        state >= 0 && state != TIME_ERROR && (kernel.status & STA_UNSYNC) == 0;
    if (state == TIME_INS) reading.leap = timing::LeapSecond::inserted;
    if (state == TIME_DEL) reading.leap = timing::LeapSecond::removed;
    reading.max_error_us = kernel.maxerror;
    reading.estimated_error_us = kernel.esterror;
    return reading;
}

Nanoseconds HostClock::real_span(Nanoseconds instrument_span) const {
    if (!scale_) return instrument_span;
    return from_seconds(std::chrono::duration<double>(instrument_span).count() / scale_->factor);
}

Nanoseconds HostClock::instrument_span(Nanoseconds real_span) const {
    if (!scale_) return real_span;
    return from_seconds(std::chrono::duration<double>(real_span).count() * scale_->factor);
}

std::string HostClock::boot_id() const {
    if (scale_) return "simulated";
    std::string id;
    std::ifstream("/proc/sys/kernel/random/boot_id") >> id;
    return id;
}

}  // namespace a351::daemon::source
