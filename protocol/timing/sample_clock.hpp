#pragma once
/// @file
/// Sample index -> UTC with uncertainty.  No threads, no system calls, no clock is read here.
///
/// A frame arrives late by a constant (filter, conversion, wire time) plus a delay that is never
/// negative, so the truth lies on the lower edge of the arrivals.  This first version lays a line
/// of the nominal rate through the earliest arrivals; its uncertainty says so.

#include <cstdint>
#include <deque>
#include <optional>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/timing/clock_reading.hpp"

namespace a351::timing {

enum class TimingState { unlocked, coarse, locked, holdover };

struct SampleTime {
    UtcTime utc;                 ///< Instant the sample stands for, group delay removed.
    Nanoseconds uncertainty{0};  ///< 95 %: model and host clock together.
    TimingState state = TimingState::unlocked;
};

struct SampleClockOptions {
    Hertz rate{50.0};            ///< Nominal output rate.
    Nanoseconds fixed_delay{0};  ///< Sample instant -> last byte of its frame on the wire.
};

/// The line, in host time:
///
///     raw(k) = k / rate + min over frames j of (arrival_j - j / rate + r (k - j) / rate)
///
/// with r = 110 ppm, the most by which the device's and the host's rates are taken to differ: an
/// old arrival counts less and less, so the line follows both oscillators.  The latest clock
/// reading carries it to UTC.
///
/// Published times are a function of what was observed before, never of who asked when: the line
/// is fixed a second of data at a time, when the first frame of that second is observed, at
/// nominal rate plus at most 0.2 ms towards the line above.  So they never jump, and a replay of
/// the same observations gives the same times.
///
/// Uncertainty of a sample, as of now, for recent samples:
///
///     16 ms + 2 r x (time since the line was last touched by an arrival) + r x |age of the sample|
///     + 100 ppm x |sample - clock reading| + host clock + |published - line|
///
/// 16 ms: the least delay is not known, up to the latency timer of an FTDI adapter as delivered
/// (FTDI AN232B-04, section 3.3).  Host clock: the kernel's maximum error; at least 1 s while it is
/// not synchronised.  Holds while every stretch has an arrival with less delay than 16 ms.
class SampleClock {
public:
    explicit SampleClock(SampleClockOptions options);

    /// Readings come in the order of time, about one a second.
    void observe_clock(const ClockReading& reading);

    /// @param arrival  host time of the last byte of the frame, wire time of later bytes of the
    ///                 same read already subtracted.  Indices rise, from 0.
    void observe(std::int64_t index, RawTime arrival);

    /// The time of a sample.  Fixed for samples up to the last one observed; later ones, and ones
    /// older than the 24 h of data that are remembered, are extrapolated at nominal rate.
    /// std::nullopt before the first clock reading and arrival.
    [[nodiscard]] std::optional<SampleTime> time_of(std::int64_t index) const;

    /// Index of the first sample at or after `utc`; std::nullopt before the first sample whose
    /// time is still remembered, or after the last one observed.
    [[nodiscard]] std::optional<std::int64_t> index_at(UtcTime utc) const;

    [[nodiscard]] TimingState state() const noexcept;

    /// Of the last sample observed; 0 before there is one.
    [[nodiscard]] Nanoseconds uncertainty() const;

private:
    /// Published times from sample `first` on: `step` per second of data.
    struct Piece {
        std::int64_t first = 0;
        UtcTime time;
        Nanoseconds step{0};
    };

    void fix_until(std::int64_t index);
    [[nodiscard]] RawTime line(std::int64_t index) const;
    [[nodiscard]] UtcTime target(std::int64_t index) const;
    [[nodiscard]] UtcTime published(std::int64_t index) const;
    [[nodiscard]] UtcTime on(const Piece& piece, std::int64_t index) const;
    [[nodiscard]] Nanoseconds duration(std::int64_t samples) const;

    SampleClockOptions options_;
    std::int64_t samples_per_step_;
    Nanoseconds nominal_step_;
    std::optional<ClockReading> reading_;
    std::optional<RawTime> start_;  // arrival - index / rate on the line at touched_
    std::int64_t touched_ = 0;      // index of the arrival that lies on the line
    std::int64_t first_ = 0;
    std::int64_t last_ = 0;
    std::deque<Piece> pieces_;
    std::int64_t fixed_until_ = 0;  // first sample whose time is not fixed
};

}  // namespace a351::timing
