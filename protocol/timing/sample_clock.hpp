#pragma once
/// @file
/// Sample index -> UTC with uncertainty.  No threads and no system calls; no clock is read here.
///
///     SampleClock clock({Hertz(50.0), fixed_delay});
///     clock.observe_clock(reading);              // about once per second
///     clock.observe(index, arrival);             // for each frame
///     if (const auto time = clock.time_of(index)) use(time->utc, time->uncertainty);
///
/// For a recording that is over, Hindsight gives better times; SampleClock::use() takes them.

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/timing/arrival_edge.hpp"
#include "protocol/timing/clock_reading.hpp"
#include "protocol/timing/utc_mapping.hpp"

namespace a351::timing {

/// State of the sample clock.  Times are given in every state; judge them by their uncertainty.  A
/// record is marked as locked only if the state is `locked` and the host is synchronised.
enum class State {
    unlocked,  ///< Less than 60 s of data.
    coarse,    ///< None of the other states.
    locked,    ///< Line known to 3 ms, the best behind a 16 ms timer in step with the sensor.
    holdover,  ///< The host's clock lost its synchronisation, or jumped and is not trusted yet.
};

/// Time of one sample, and how well it is known.
struct SampleTime {
    UtcTime utc;                 ///< Instant of the sample, fixed delay removed.
    Nanoseconds uncertainty{0};  ///< Uncertainty of `utc`, 95 %: line and host clock together.
    State state = State::unlocked;
    bool is_host_synchronised = false;  ///< UtcMapping::is_synchronised().
};

/// Times from sample `first` on: `step` per second of data, until the next piece.
///
///     time of sample k = time + (k - first) / (samples per second of data) x step
struct TimePiece {
    std::int64_t first = 0;      ///< First sample of the piece.
    UtcTime time;                ///< Time of sample `first`.
    Nanoseconds step{0};         ///< UTC per second of data (as many samples as the rate, rounded).
    Nanoseconds uncertainty{0};  ///< Uncertainty of `time`, 95 %.
    bool is_break = false;       ///< The times jump before this piece.
};

/// Measured output rate: samples over time, between two samples without a jump in between.
/// The true rate lies within `uncertainty_ppm` of it if both times are right to their
/// uncertainties.
struct MeasuredRate {
    Hertz rate;                    ///< Samples per second of UTC.
    double uncertainty_ppm = 0.0;  ///< Sum of the uncertainties of both times, over the span.
    Nanoseconds span{0};           ///< Time between the two samples.
};

/// Properties of the sensor's stream that do not change within a session.
struct SampleClockOptions {
    Hertz rate{50.0};            ///< Nominal output rate, > 0; not checked.
    Nanoseconds fixed_delay{0};  ///< From the sample instant to the last byte of its frame.
};

/// Gives each sample its UTC: ArrivalEdge fits the line in host time, UtcMapping maps it to UTC.
///
/// Published times depend only on the observations before, not on when they are asked for; a replay
/// of the same observations gives the same times.  They are fixed one second of data at a time,
/// when its first frame is observed, at the rate of the line plus at most 0.2 ms towards the line;
/// so they do not jump.  They jump only if the difference exceeds 5 ms and the mapping followed a
/// step of the host's clock, the host slept, or more than 24 h of data were lost.  Such a break
/// begins with a sample.
///
/// Nothing is fixed before 2 s of data are complete; times until then are provisional.
///
/// Uncertainty (95 %) of a recent sample, as known now:
///
///     line + uncertainty of its rate x |age of the sample| + |published - line| + host clock
///
/// A sleeping host stops its raw clock, but the sensor continues.  The time that CLOCK_BOOTTIME
/// gains on the raw clock between two readings is added to all later raw times.
///
/// Accuracy (clock_days_test.cpp, 50 Hz, seeds not used in development): behind a 16 ms timer 99 %
/// of the times are within 1.0 ms after 10 min (2.5 ms if the timer is in step with the sensor),
/// all within 4.5 ms after 1 min; behind a 1 ms timer 99 % within 0.3 ms after 10 min.  The stated
/// uncertainty covers at least 95 %.  Without delays: 0.1 ms (sample_clock_test.cpp).
///
/// Memory: up to 3.5 MB, for the times of 24 h.  A copy has the same times and continues on its
/// own.  Several threads may call const functions at a time, but no other function meanwhile.
class SampleClock {
public:
    /// Begins without any reading or arrival: no time is known yet.
    explicit SampleClock(SampleClockOptions options);

    /// Adds a reading of the host's clocks, about one per second.  The first reading after a sleep
    /// must come before any arrival after it.  A reading that is not later than the previous one is
    /// ignored.  All readings must be of one boot of the host; not checked.
    void observe_clock(const ClockReading& reading);

    /// Adds the arrival of a sample.  Samples may be missing before it.
    ///
    /// Cost: O(1); once per 2 s of data a fit of up to 450 blocks.
    /// @param index    rises from call to call, from 0; not checked.
    /// @param arrival  raw time of the last byte of the frame; the wire time of later bytes of the
    ///                 same read is already subtracted.
    void observe(std::int64_t index, RawTime arrival);

    /// Starts again at index 0, because the sensor restarted.  The host's clock and the rate of the
    /// sensor remain known.
    void restart_index();

    /// Replaces all times until restart_index() by given ones.  An empty list only forgets the
    /// published times.
    ///
    /// From now on is_fixed() is true for every sample, and observe() only notes the newest sample
    /// and the breaks.  SampleTime::state is `locked` or `coarse`, by the uncertainty of the piece.
    /// @param times  in rising order of `first`; the first piece also holds for earlier samples.
    /// @param is_host_synchronised  stated in the time of every sample.
    void use(const std::vector<TimePiece>& times, bool is_host_synchronised);

    /// Returns the raw time plus the time slept so far: the raw clock of a host that never slept.
    [[nodiscard]] RawTime awake(RawTime raw) const noexcept { return raw + slept_; }

    /// Returns the time of a sample; std::nullopt before the first clock reading and arrival.
    /// Times of samples up to the last one observed are fixed, see is_fixed().  Later samples, and
    /// those older than the 24 h of data that are remembered, are extrapolated at the nominal rate.
    ///
    /// Only `utc` is fixed: uncertainty and state are those known now.  Cost: O(log n) for n
    /// remembered pieces, at most one per second of data.
    [[nodiscard]] std::optional<SampleTime> time_of(std::int64_t index) const;

    /// Returns true if the time of an observed sample will not change any more.
    [[nodiscard]] bool is_fixed(std::int64_t index) const noexcept {
        return is_given_ || (!pieces_.empty() && index < fixed_until_);
    }

    /// Returns the first sample at or after `utc`: the inverse of time_of().  std::nullopt before
    /// the first sample whose time is remembered, and after the last one observed.
    ///
    /// The search assumes rising times.  After a jump back, an instant that occurs twice gives one
    /// of its two samples.
    [[nodiscard]] std::optional<std::int64_t> index_at(UtcTime utc) const;

    /// Returns the newest sample before which the published times jump; std::nullopt if they did
    /// not since the last restart_index().  A record must end before this sample.
    [[nodiscard]] std::optional<std::int64_t> last_break() const noexcept { return last_break_; }

    /// Returns the state at the newest sample observed.  It describes the fitted line, so it means
    /// nothing for times given by use(); SampleTime::state does.
    [[nodiscard]] State state() const noexcept;

    /// Returns true if the host's clock is synchronised now: UtcMapping::is_synchronised().
    [[nodiscard]] bool is_host_synchronised() const noexcept { return mapping_.is_synchronised(); }

    /// Returns the rate of the sensor's oscillator, from the newest sample and an earlier one.  The
    /// earlier one is within the remembered 24 h, after the last break, and gives the least
    /// uncertainty.
    ///
    /// std::nullopt while the span is below 1 min or the uncertainty above 110 ppm, and for times
    /// given by use().  Also if the rate is more than 100 ppm from the nominal one, which the line
    /// cannot follow.
    ///
    /// Cost: O(n) for n remembered pieces, at most one per second of data.
    ///
    /// Accuracy: the error is within the stated uncertainty, which is below 1 ppm after 2 h behind
    /// a 16 ms adapter (sample_clock_test.cpp, "the rate of the sensor is measured as well as it
    /// says").
    [[nodiscard]] std::optional<MeasuredRate> measured_rate() const;

    /// Returns the uncertainty of the last sample observed, 95 %; 0 before there is one, or before
    /// its time is known.  Do not read 0 as exact.
    [[nodiscard]] Nanoseconds uncertainty() const;

    /// Returns the part of uncertainty() that is the host's clock; 0 for times given by use().
    [[nodiscard]] Nanoseconds host_uncertainty() const;

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
    bool is_given_ = false;         ///< The pieces were given by use().
    std::int64_t fixed_until_ = 0;  ///< First sample whose time is not fixed.
    bool may_jump_ = false;
    bool is_given_synchronised_ = false;
    std::optional<std::int64_t> last_break_;
};

}  // namespace a351::timing
