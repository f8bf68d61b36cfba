#pragma once
/// @file
/// The host's raw clock -> UTC, from readings of both.

#include <deque>
#include <optional>

#include "protocol/core/utc_time.hpp"
#include "protocol/timing/clock_reading.hpp"

namespace a351::timing {

/// Follows the readings one by one, so that what a time service slews is followed within seconds,
/// and doubts those that jump:
///
/// A step is a reading that departs from the last one followed by more than 50 ms + 600 ppm of the
/// time between (a kernel slews at 500 ppm at most).  It is doubted: the mapping goes on at its rate
/// of the last seconds, at most 100 ppm.  When the host has said for 60 s that it is synchronised,
/// and has kept to the new time, that is followed.  A host that was never synchronised needs only
/// the 60 s, and is followed at once when it is synchronised for the first time, unless it woke up
/// within the last minute.
///
/// The second that the host's clock is set back or ahead by at the end of a day for which the kernel
/// announced it is no doubt: it is followed at once.  Within 2 minutes of it the error is 1 s at least.
///
/// Error: the kernel's maximum error.  Held, or without synchronisation: that of the last
/// synchronised reading + 100 ppm of the time since (a host's crystal) + the rate that is carried on
/// since the last reading that was followed.  Never synchronised, or awake for less than a minute
/// (only a battery clock counts while a host sleeps): at least 1 s.
class UtcMapping {
public:
    /// In the order of time.  @return  by how much the clock was set, if that is followed from this
    /// reading on; positive: ahead.
    std::optional<Nanoseconds> observe(const ClockReading& reading);

    /// The host slept until the next reading.
    void woke_up();

    [[nodiscard]] bool is_empty() const noexcept { return recent_.empty(); }
    /// There is a reading.
    [[nodiscard]] UtcTime at(RawTime raw) const;
    [[nodiscard]] Nanoseconds error_at(RawTime raw) const;
    /// The host was synchronised and is not any more, or not by our account.
    [[nodiscard]] bool is_held() const noexcept;
    /// It says so, no step is doubted, and it was awake for a minute.
    [[nodiscard]] bool is_synchronised() const noexcept;

private:
    struct Pair {
        RawTime raw;
        Nanoseconds offset{0};  ///< UTC since 1970 - raw.
    };
    struct Doubted {
        RawTime since;
        Nanoseconds offset{0};
    };
    [[nodiscard]] double slope() const;
    [[nodiscard]] Nanoseconds offset_at(RawTime raw) const;
    [[nodiscard]] bool is_just_awake(RawTime raw) const noexcept;
    [[nodiscard]] bool is_leap(const ClockReading& reading, Nanoseconds departure) const noexcept;
    void follow(const ClockReading& reading, Nanoseconds offset);

    std::deque<Pair> recent_;  ///< The last 3 s, and one before.
    std::optional<Doubted> doubted_;
    bool has_slept_ = false;
    std::optional<RawTime> awake_since_;
    std::optional<UtcTime> leap_at_;                 ///< The midnight last announced.
    std::optional<ClockReading> last_;               ///< Followed.
    std::optional<ClockReading> last_synchronised_;  ///< Followed.
};

}  // namespace a351::timing
