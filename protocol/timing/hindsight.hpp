#pragma once
/// @file
/// Times of samples once everything is known: arrivals and clock readings before and after.

#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/timing/arrival_edge.hpp"
#include "protocol/timing/clock_reading.hpp"
#include "protocol/timing/sample_clock.hpp"

namespace a351::timing {

/// The host's raw clock -> UTC by straight lines between readings.
///
/// Where any reading says that the host was synchronised only such readings are used: what lies
/// before the first or after the last is carried on at the rate of the readings next to it, and a
/// clock that was wrong until then is mended.  Readings that differ by more than 50 ms + 600 ppm of
/// the time between are a step; the jump is put at the later one.  A clock that was set and set back
/// within a minute was not set.
///
/// Within 2 minutes of an announced leap second the error is 1 s at least.
///
/// What the host slept, by boottime, is added to its raw clock; a time that a sleep parts from the
/// reading it rests on is good to 1 s.
class UtcHistory {
public:
    /// In the order of time, of one boot of the host.
    void observe(const ClockReading& reading);

    struct Point {
        UtcTime utc;
        Nanoseconds error{0};  ///< Of the host's clock, 95 %.
        int stretch = 0;       ///< Between two jumps.
    };
    /// There is a reading.  `sleeps` of the host lie before that instant: raw time does not tell, for
    /// the reading that shows a sleep is later than what came first after it.
    [[nodiscard]] Point at(RawTime raw, std::size_t sleeps) const;

    /// That the readings so far show.
    [[nodiscard]] std::size_t sleeps() const noexcept { return slept_.size(); }

    [[nodiscard]] bool is_empty() const noexcept { return pairs_.empty(); }
    [[nodiscard]] bool is_synchronised() const noexcept { return is_synchronised_; }

private:
    struct Pair {
        RawTime awake;          ///< Raw time and what was slept.
        Nanoseconds offset{0};  ///< UTC since 1970 - awake.
        Nanoseconds error{0};
        std::size_t sleeps = 0;
        int stretch = 0;
    };
    using Pairs = std::vector<Pair>;

    void notice_sleep(const ClockReading& reading);
    [[nodiscard]] RawTime awake(RawTime raw, std::size_t sleeps) const;
    void join(Pair& pair);
    [[nodiscard]] Point between(RawTime raw, std::size_t sleeps) const;
    [[nodiscard]] Point beyond(Pairs::const_iterator pair, RawTime awake, std::size_t sleeps) const;

    bool is_synchronised_ = false;
    std::optional<ClockReading> last_;
    std::vector<UtcTime> leaps_;      ///< Midnights announced.
    std::vector<Nanoseconds> slept_;  ///< Of each sleep, with all before.
    Pairs pairs_;
};

/// One run of a sensor: every second of data from the arrivals within 450 s before and after it.
///
/// Accuracy (clock_days_test, out of sample): behind a 16 ms timer that is not in step 99 % within
/// 0.5 ms.
class Hindsight {
public:
    /// @param sleeps  of the host, by UtcHistory, before the first arrival.
    Hindsight(SampleClockOptions options, std::size_t sleeps);

    /// As SampleClock::observe.
    void observe(std::int64_t index, RawTime arrival);

    /// The host has slept so often, by UtcHistory: the next arrival stands for itself, as does the
    /// first after more than 24 h of data were lost.
    void host_slept(std::size_t sleeps);

    [[nodiscard]] std::vector<TimePiece> times(const UtcHistory& history) const;

private:
    struct Stretch {
        std::int64_t first, last;
        std::size_t sleeps;
        ArrivalEdge edge;
    };
    SampleClockOptions options_;
    SamplePeriod period_;
    std::vector<Stretch> stretches_;
    std::size_t sleeps_;
    bool begins_stretch_ = true;
};

}  // namespace a351::timing
