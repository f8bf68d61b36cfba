#pragma once
/// @file
/// Sample index -> UTC with uncertainty.  No threads, no system calls, no clock is read here.

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/timing/arrival_edge.hpp"
#include "protocol/timing/clock_reading.hpp"
#include "protocol/timing/sample_period.hpp"
#include "protocol/timing/utc_mapping.hpp"

namespace a351::timing {

/// unlocked: less than 60 s of data.  holdover: the host's clock lost its synchronisation, or
/// jumped and is not believed yet.  locked: the line is known to 3 ms (a timer of 16 ms in step with
/// the sensor allows no better).  coarse: none of these.
enum class TimingState { unlocked, coarse, locked, holdover };

struct SampleTime {
    UtcTime utc;                 ///< Instant the sample stands for, group delay removed.
    Nanoseconds uncertainty{0};  ///< 95 %: model and host clock together.
    TimingState state = TimingState::unlocked;
    bool is_host_synchronised = false;  ///< By its own account, and it did not jump lately.
};

/// Times from sample `first` on: `step` per second of data, until the next piece.
struct TimePiece {
    std::int64_t first = 0;
    UtcTime time;
    Nanoseconds step{0};
    Nanoseconds uncertainty{0};  ///< Of `time`.
    bool is_break = false;       ///< The times jump.
};

/// Samples over time, between two samples whose times do not jump.
struct MeasuredRate {
    Hertz rate;
    double uncertainty_ppm = 0.0;  ///< Those of both times together, over the span.
    Nanoseconds span{0};
};

struct SampleClockOptions {
    Hertz rate{50.0};            ///< Nominal output rate.
    Nanoseconds fixed_delay{0};  ///< Sample instant -> last byte of its frame on the wire.
};

/// The line in host time is that of ArrivalEdge, UtcMapping carries it to UTC.
///
/// Published times are a function of what was observed before, never of who asked when: the line
/// is fixed a second of data at a time, when the first frame of that second is observed, at the
/// line's rate plus at most 0.2 ms towards the line.  So they never jump, and a replay of the same
/// observations gives the same times.  They do jump where the mapping follows a step of the host's
/// clock, the host slept, or more than 24 h of data were lost, if that is more than 5 ms: a break,
/// which begins with a sample.
///
/// Nothing is fixed before 2 s of data are complete; times asked for until then are provisional.
///
/// Uncertainty of a sample, as of now, for recent samples:
///
///     line + uncertainty of its rate x |age of the sample| + |published - line| + host clock
///
/// A host that sleeps stops its raw clock but not the sensor: what boottime gained on the raw clock
/// between two readings is added to all raw times after.
class SampleClock {
public:
    explicit SampleClock(SampleClockOptions options);

    /// About one a second, and the first one after a sleep before any arrival after it.  One that
    /// is not later than the one before says nothing new.
    void observe_clock(const ClockReading& reading);

    /// @param arrival  host time of the last byte of the frame, wire time of later bytes of the
    ///                 same read already subtracted.  Indices rise, from 0.
    void observe(std::int64_t index, RawTime arrival);

    /// The sensor restarted: indices begin anew.  What is known of the host's clock is kept, and
    /// the rate of the sensor.
    void restart_index();

    /// From now to restart_index() the times are these, of a host that was synchronised or not.
    void use(const std::vector<TimePiece>& times, bool is_host_synchronised);

    /// The raw clock as if the host had never slept.
    [[nodiscard]] RawTime awake(RawTime raw) const noexcept { return raw + slept_; }

    /// The time of a sample.  Fixed for samples up to the last one observed; later ones, and ones
    /// older than the 24 h of data that are remembered, are extrapolated at nominal rate.
    /// std::nullopt before the first clock reading and arrival.
    [[nodiscard]] std::optional<SampleTime> time_of(std::int64_t index) const;

    /// The time of this sample, one observed, stays as it is.
    [[nodiscard]] bool is_fixed(std::int64_t index) const noexcept {
        return is_given_ || (!pieces_.empty() && index < fixed_until_);
    }

    /// Index of the first sample at or after `utc`; std::nullopt before the first sample whose
    /// time is still remembered, or after the last one observed.
    [[nodiscard]] std::optional<std::int64_t> index_at(UtcTime utc) const;

    /// The newest sample before which the published times jump.
    [[nodiscard]] std::optional<std::int64_t> last_break() const noexcept { return last_break_; }

    [[nodiscard]] TimingState state() const noexcept;

    /// Of the sensor's oscillator, from the newest sample and that of the 24 h remembered with which
    /// it is known best; std::nullopt before a minute.  Accuracy: "the rate of the sensor is measured
    /// as well as it says".
    [[nodiscard]] std::optional<MeasuredRate> measured_rate() const;

    /// Of the last sample observed; 0 before there is one.
    [[nodiscard]] Nanoseconds uncertainty() const;

private:
    void fix_until(std::int64_t index);
    void fix_second();
    [[nodiscard]] RawTime line_at(std::int64_t index) const;
    [[nodiscard]] UtcTime target(std::int64_t index) const;
    [[nodiscard]] UtcTime published(std::int64_t index) const;
    [[nodiscard]] const TimePiece& piece_of(std::int64_t index) const;
    [[nodiscard]] UtcTime on(const TimePiece& piece, std::int64_t index) const;

    SampleClockOptions options_;
    SamplePeriod period_;
    UtcMapping mapping_;
    ArrivalEdge edge_;
    std::optional<EdgeLine> line_;
    std::optional<ClockReading> reading_;
    Nanoseconds slept_{0};
    std::optional<std::int64_t> first_, last_;
    std::deque<TimePiece> pieces_;
    bool is_given_ = false;         // times: the pieces are not ours
    std::int64_t fixed_until_ = 0;  // first sample whose time is not fixed
    bool may_jump_ = false;
    bool is_given_synchronised_ = false;
    std::optional<std::int64_t> last_break_;
};

}  // namespace a351::timing
