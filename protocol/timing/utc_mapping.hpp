#pragma once
/// @file
/// The host's raw clock -> UTC, from readings of both clocks.
///
/// SampleClock uses it for times while samples arrive.  UtcHistory does the same in hindsight.
///
///     UtcMapping mapping;
///     if (mapping.observe(reading)) note_jump();   // about once per second
///     const UtcTime utc = mapping.at(raw);
///     const Nanoseconds error = mapping.error_at(raw);

#include <deque>
#include <optional>

#include "protocol/core/utc_time.hpp"
#include "protocol/timing/clock_reading.hpp"

namespace a351::timing {

/// Follows the clock readings one by one, so that slewing by a time service is followed within
/// seconds.  Readings that jump are doubted first.
///
/// A step is a reading that departs from the mapping by more than 50 ms + 600 ppm of the time since
/// the last followed reading (a kernel slews at 500 ppm at most).  While a step is doubted, the
/// mapping continues at its rate of the last seconds, at most 100 ppm.  The step is followed when
/// the host has kept the new time and has reported synchronisation for 60 s.  For a host that was
/// never synchronised the 60 s are sufficient.  Its first synchronisation is followed at once,
/// unless it woke up within the last minute.
///
/// A leap second is followed at once if the kernel announced it for the end of that day.  Within
/// 2 min of it the error is at least 1 s.
///
/// Error: the kernel's maximum error at the last synchronised reading + 100 ppm of the time since
/// (a host crystal) + the rate of the mapping x the time since the last followed reading.  At least
/// 1 s if the host was never synchronised or has been awake for less than a minute, because only a
/// battery clock counts while a host sleeps.
///
/// Accuracy (utc_mapping_test.cpp): a slew of 500 ppm is followed to 1 ms, 1.5 s after a reading.
/// While a step after such a slew is doubted for an hour, the stated error covers the true one.
///
/// All functions are O(1), because only the readings of the last 3 s are kept.  No clock is read,
/// and the result depends only on the readings.  Not thread-safe.
class UtcMapping {
public:
    /// Adds a reading.
    /// @param reading  later than the one before; not checked.  Its `raw` must include the time
    ///                 that the host slept, see SampleClock::awake().
    /// @return  the step of the host's clock, positive if it was set ahead, if the mapping follows
    ///          a step from this reading on; else std::nullopt.
    std::optional<Nanoseconds> observe(const ClockReading& reading);

    /// Notes that the host slept between the last reading and the next one.  Call it before the
    /// reading that shows the sleep.
    void woke_up() { has_slept_ = true; }

    /// Returns true before the first reading.
    [[nodiscard]] bool is_empty() const noexcept { return recent_.empty(); }
    /// Returns the UTC of a raw time; exact at the newest followed reading.  Other times lie on the
    /// line of the last 3 s, so the past is not kept.  Precondition: not is_empty().
    [[nodiscard]] UtcTime at(RawTime raw) const;
    /// Returns the error of at(), see above.  Precondition: not is_empty().  It does not grow for
    /// times before the newest readings.
    [[nodiscard]] Nanoseconds error_at(RawTime raw) const;
    /// Returns true if the host was synchronised before and is_synchronised() is false now.  A
    /// sample clock with 60 s of data is then in the state `holdover`.
    [[nodiscard]] bool is_held() const noexcept;
    /// Returns true if the host reports synchronisation, no step is doubted, and the host has been
    /// awake for a minute.
    [[nodiscard]] bool is_synchronised() const noexcept;

private:
    struct Pair {
        RawTime raw;
        Nanoseconds offset{0};  ///< UTC since 1970 minus `raw`.
    };
    [[nodiscard]] double slope() const;
    [[nodiscard]] Nanoseconds offset_at(RawTime raw) const;
    [[nodiscard]] bool is_just_awake(RawTime raw) const noexcept;
    [[nodiscard]] bool is_leap(const ClockReading& reading, Nanoseconds departure) const noexcept;
    void follow(const ClockReading& reading, Nanoseconds offset);

    std::deque<Pair> recent_;      ///< Followed readings of the last 3 s, and one before.
    std::optional<Pair> doubted_;  ///< Raw time since when, and newest offset.
    bool has_slept_ = false;
    std::optional<RawTime> awake_since_;
    std::optional<UtcTime> leap_at_;    ///< Midnight of the last announced leap second.
    std::optional<ClockReading> last_;  ///< Last followed reading.
    std::optional<ClockReading> last_synchronised_;  ///< Last one of these that was synchronised.
};

}  // namespace a351::timing
