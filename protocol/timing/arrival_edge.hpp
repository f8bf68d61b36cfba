#pragma once
/// @file
/// Arrival times of frames -> the line of the earliest ones, sample by sample.
///
/// SampleClock uses it while samples arrive, Hindsight afterwards.  No clock is read here; all
/// times are on the raw clock of the host.
///
///     ArrivalEdge edge(Hertz(50.0));
///     edge.observe(index, arrival);                                // for each frame
///     const RawTime punctual = edge.line().at(index, period);      // less the delays of the host

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/timing/edge_fit.hpp"

namespace a351::timing {

/// Nominal time from sample to sample.  Times are counted in seconds of data (as many samples as
/// the rate, rounded) and a rest, so that for whole rates no rounding grows with the index.
class SamplePeriod {
public:
    /// @param rate  nominal output rate, > 0; not checked.
    explicit SamplePeriod(Hertz rate)
        : per_second_(std::max<std::int64_t>(1, std::llround(rate.value()))),
          second_(from_seconds(static_cast<double>(per_second_) / rate.value())) {}

    /// Returns the rate in samples per second, rounded to a whole number, at least 1.
    [[nodiscard]] std::int64_t per_second() const noexcept { return per_second_; }

    /// Returns the nominal duration of `samples` sample periods; `samples` may be negative.  The
    /// duration must be below 292 years; not checked.
    ///
    /// Accuracy: 1 ns for a whole rate, else 1 ns + 1e-9 of the duration.
    [[nodiscard]] Nanoseconds of(std::int64_t samples) const noexcept {
        return samples / per_second_ * second_ + samples % per_second_ * second_ / per_second_;
    }

private:
    std::int64_t per_second_;
    Nanoseconds second_;
};

/// Arrival times of frames that nothing delays, as a line over the sample index:
///
///     at(k) = arrival + (1 + skew) (k - index) / rate
///
/// A delay common to all frames cannot be seen in the arrivals.  The line excludes its likely
/// part, and the uncertainty covers the rest.  A default-constructed line means nothing.
struct EdgeLine {
    std::int64_t index = 0;         ///< Sample at which the line was fitted.
    RawTime arrival;                ///< Arrival of that sample without delay, on the raw clock.
    double skew = 0.0;              ///< Raw seconds per nominal second of data, less 1.
    Nanoseconds uncertainty{0};     ///< Uncertainty of `arrival`, 95 %.
    double skew_uncertainty = 0.0;  ///< Half the range of `skew` that the arrivals allow.

    /// Returns the arrival of sample `other` without delay; `other` may lie on either side.
    /// The uncertainty grows by `skew_uncertainty` x the time between both samples.
    /// @param period  period of the rate for which the line was fitted; not checked.
    [[nodiscard]] RawTime at(std::int64_t other, const SamplePeriod& period) const {
        const Nanoseconds after = period.of(other - index);
        return arrival + after + from_seconds(skew * std::chrono::duration<double>(after).count());
    }
};

/// Collects arrivals in blocks of 2 s of data, of the last 900 s or of all data, and fits lines to
/// the earliest arrival of each block.  Formula, accuracy and source: fit_edge().
///
/// A first block of less than 0.4 s of data is ignored: its frames may have waited unread while the
/// host slept, and would alone determine the line.
///
/// Memory: one small entry per 2 s of data, about 450 for `window`.  Not thread-safe.  Lost and
/// late frames need no special call; a sleep of the host and a new index need restart().
class ArrivalEdge {
public:
    enum class Memory { window, all };  ///< Blocks that are kept: of the last 900 s, or all.

    /// @param rate  nominal output rate, > 0; not checked.
    explicit ArrivalEdge(Hertz rate, Memory memory = Memory::window);

    /// Adds the arrival of a sample.  Any number of samples may be missing before it.
    /// Cost: O(1); at the end of a block O(n log n) in its n arrivals.
    /// @param index    rises from call to call; otherwise the program ends (require_invariant()).
    /// @param arrival  time of the last byte of the frame on the raw clock.
    void observe(std::int64_t index, RawTime arrival);

    /// Forgets the arrivals.  During the next 300 s of data the rate is limited to its previous
    /// value +-10 ppm, or +- its uncertainty if that was larger.  Before is_settled() the rate is
    /// not known, and the limits remain as they were.
    void restart();

    /// Returns true if there is no arrival.  The lines are undefined then.
    [[nodiscard]] bool is_empty() const noexcept { return blocks_.empty(); }

    /// Returns true once 2 s of data are complete, so that the timer of an adapter would show.
    [[nodiscard]] bool is_settled() const noexcept { return blocks_.size() > 1; }

    /// Returns the line at the newest sample, fitted to the complete blocks, or to the only block.
    ///
    /// It is fitted in O(blocks) at the first call after a block was completed, and kept until the
    /// next block is complete.  Until the first block is complete, each arrival makes a new line.
    /// Call it after every observe(): a later first call would give the line at a later sample.
    /// Precondition: not is_empty().  The reference is valid until the next call of a function that
    /// is not const.
    [[nodiscard]] const EdgeLine& line();

    /// Returns the line at any sample, fitted to those of the remembered blocks that lie in the
    /// 900 s around it; near an end of the data, in the first or last 900 s.
    /// Precondition: not is_empty().  Each call fits in O(blocks) and keeps nothing.
    [[nodiscard]] EdgeLine line_around(std::int64_t index) const;

private:
    void close_block();
    [[nodiscard]] std::span<const ArrivalBlock> complete_blocks() const;
    [[nodiscard]] EdgeLine fit(std::span<const ArrivalBlock> blocks, std::int64_t index) const;

    SamplePeriod period_;
    Memory memory_;
    RateLimits limits_;
    RawTime zero_;
    std::int64_t newest_ = 0;
    std::vector<ArrivalBlock> blocks_;
    std::vector<Nanoseconds> open_block_;  ///< All y of the newest block.
    bool is_first_block_ = true;           ///< No block was completed since restart().
    std::optional<EdgeLine> line_;
};

}  // namespace a351::timing
