#pragma once

#include <cstdint>

#include "protocol/core/utc_time.hpp"

namespace a351::timing {

/// Leap second that the kernel will make at the end of the UTC day.
enum class LeapSecond : std::uint8_t { none = 0, inserted = 1, removed = 2 };

/// The host's clocks read together, and the state of synchronisation that the kernel reports.
struct ClockReading {
    RawTime raw;                          ///< CLOCK_MONOTONIC_RAW.
    Nanoseconds boottime{0};              ///< CLOCK_BOOTTIME: also counts while suspended.
    UtcTime realtime;                     ///< CLOCK_REALTIME at the instant `raw`.
    bool is_synchronised = false;         ///< adjtimex: neither TIME_ERROR nor STA_UNSYNC.
    std::int64_t max_error_us = 0;        ///< adjtimex maxerror.
    std::int64_t estimated_error_us = 0;  ///< adjtimex esterror.
    LeapSecond leap = LeapSecond::none;   ///< adjtimex: TIME_INS, TIME_DEL.

    bool operator==(const ClockReading&) const = default;
};

}  // namespace a351::timing
