#pragma once
/// @file
/// Times of samples in hindsight: from the arrivals and clock readings before and after them.
///
/// Use it for a recording that is over.  SampleClock gives times while samples arrive; it knows
/// only the past.  The order of calls is that of the recording:
///
///     UtcHistory history;
///     Hindsight run(options, history.sleeps());
///     history.observe(reading);
///     run.host_slept(history.sleeps());         // only if this reading showed a sleep
///     run.observe(index, arrival);
///     clock.use(run.times(history), history.is_synchronised());
///
/// No clock is read; the same input gives the same times.

#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/timing/arrival_edge.hpp"
#include "protocol/timing/clock_reading.hpp"
#include "protocol/timing/sample_clock.hpp"

namespace a351::timing {

/// Maps the host's raw clock to UTC by straight lines between clock readings.
///
/// If any reading shows a synchronised host, only such readings are used.  Before the first and
/// after the last of them, time is extrapolated at the mean rate of their stretch; so a clock that
/// was wrong before its synchronisation is corrected.  Two readings whose offsets differ by more
/// than 50 ms + 600 ppm of the time between them are a step; the jump is placed at the later one
/// and begins a new stretch.  A clock that was set and set back within a minute counts as not set.
/// A sleep begins a new stretch, too.
///
/// The time that the host slept, by CLOCK_BOOTTIME, is added to its raw clock.
///
/// Error (95 %): between two readings of a stretch the larger of their maximum errors + 100 ppm of
/// the time to the nearer one.  Outside, the error of the reading + 5 ppm of the time to it + the
/// error of the rate of its stretch, together at most 100 ppm.  1 s more if a sleep lies between.
/// At least 1 s if no reading is synchronised, and within 2 min of an announced leap second.
///
/// Accuracy: within 1 ms of the truth after a sleep, and while a clock was set and set back, on
/// made-up hosts without slewing (hindsight_test.cpp).
///
/// One history serves all runs of a sensor within one boot of the host.  Memory grows with the
/// number of readings.
class UtcHistory {
public:
    /// Adds a reading; one that is not later than the previous one is ignored.
    /// @param reading  all of one boot of the host; not checked.  A later reading may change what
    ///                 at() returns for earlier instants.
    void observe(const ClockReading& reading);

    /// UTC of one instant.
    struct Point {
        UtcTime utc;           ///< The host's UTC, corrected as described above.
        Nanoseconds error{0};  ///< Error of the host's clock, 95 %.
        int stretch = 0;       ///< Number of the stretch between two jumps.
    };
    /// Returns the UTC of a raw time.  Precondition: not is_empty().
    ///
    /// A raw time outside the readings is extrapolated, and the error grows with the distance.
    /// Cost: O(log n) for n readings.
    /// @param raw     as the host read it, time asleep not added.
    /// @param sleeps  number of sleeps of the host before that instant.  It does not follow from
    ///                `raw`: the reading that shows a sleep is later than the first arrivals after
    ///                it.  At most sleeps(); not checked.
    [[nodiscard]] Point at(RawTime raw, std::size_t sleeps) const;

    /// Returns the number of sleeps that the readings show.  A sleep is a gain of CLOCK_BOOTTIME on
    /// the raw clock of more than 0.1 s between two readings.
    [[nodiscard]] std::size_t sleeps() const noexcept { return slept_.size(); }

    /// Returns true before the first reading.
    [[nodiscard]] bool is_empty() const noexcept { return pairs_.empty(); }
    /// Returns true if any reading showed a synchronised host.  If not, the times may be wrong by
    /// any amount, and each error is only a lower bound of at least 1 s.
    [[nodiscard]] bool is_synchronised() const noexcept { return is_synchronised_; }

private:
    struct Pair {
        RawTime awake;          ///< Raw time plus the time slept before.
        Nanoseconds offset{0};  ///< UTC since 1970 minus `awake`.
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
    std::vector<UtcTime> leaps_;      ///< Midnights of announced leap seconds.
    std::vector<Nanoseconds> slept_;  ///< Time slept up to the end of each sleep.
    Pairs pairs_;
};

/// Computes the times of one run of a sensor afterwards: each second of data from the arrivals
/// within 450 s before and after it (ArrivalEdge::line_around) and from UtcHistory.
///
/// Accuracy (clock_days_test.cpp, seeds not used in development): behind a 16 ms timer that is not
/// in step with the sensor, 99 % of the times are within 0.5 ms, and the stated uncertainty covers
/// at least 95 %.
///
/// One object serves one run of the sensor.  Memory: one small entry per 2 s of data.
class Hindsight {
public:
    /// Begins a run.
    /// @param options  rate > 0, not checked; the fixed delay is subtracted from all times.
    /// @param sleeps   UtcHistory::sleeps() before the first arrival.
    Hindsight(SampleClockOptions options, std::size_t sleeps);

    /// Adds an arrival, as SampleClock::observe().
    /// @param index    rises from call to call; not checked.
    /// @param arrival  raw time as the host read it, time asleep not added.
    void observe(std::int64_t index, RawTime arrival);

    /// Separates the next arrival from those before, because the host slept.  A loss of more than
    /// 24 h of data separates them too.
    /// @param sleeps  UtcHistory::sleeps() now.
    void host_slept(std::size_t sleeps);

    /// Returns one piece per second of data; its `uncertainty` is that of the line + that of the
    /// host's clock.  Empty without arrivals.
    ///
    /// `is_break` is true after a sleep, after a loss of more than 24 h, and where the host's UTC
    /// jumps by more than 5 ms.  Cost: one fit of up to 450 blocks per 2 s of data.
    /// @param history  not empty, unless there are no arrivals.
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
