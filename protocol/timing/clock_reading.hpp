#pragma once
/// @file
/// A reading of the host's clocks, from which the times of samples follow.
///
/// The daemon takes one about every second and journals it.  The functions of this folder get
/// readings as arguments and read no clock themselves, so a replay gives the same times.

#include <cstdint>

#include "protocol/core/utc_time.hpp"

namespace a351::timing {

/// Leap second that the kernel will make at the end of the UTC day.  After `inserted` the host's
/// UTC steps back by 1 s, after `removed` it steps ahead by 1 s.
enum class LeapSecond : std::uint8_t { none = 0, inserted = 1, removed = 2 };

/// The host's clocks read together, and the state of synchronisation that the kernel reports.
///
/// Two readings can be compared only if they are of the same boot of the host, because `raw` and
/// `boottime` begin with it.  A default-constructed reading is one of 1970, not synchronised.
struct ClockReading {
    RawTime raw;                          ///< CLOCK_MONOTONIC_RAW.
    Nanoseconds boottime{0};              ///< CLOCK_BOOTTIME: also counts while suspended.
    UtcTime realtime;                     ///< CLOCK_REALTIME at the instant `raw`.
    bool is_synchronised = false;         ///< adjtimex: neither TIME_ERROR nor STA_UNSYNC.
    std::int64_t max_error_us = 0;        ///< adjtimex maxerror: bound of the error of `realtime`.
    std::int64_t estimated_error_us = 0;  ///< adjtimex esterror.
    LeapSecond leap = LeapSecond::none;   ///< adjtimex: TIME_INS, TIME_DEL.

    bool operator==(const ClockReading&) const = default;
};

}  // namespace a351::timing
