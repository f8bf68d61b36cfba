#pragma once
/// @file
/// The 16-bit COUNT of the frames -> an index that never wraps.  While bytes are contiguous,
/// continuity decides, never elapsed time; after a loss, elapsed time chooses among the indices
/// that fit the counter.

#include <cstdint>
#include <optional>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::timing {

/// Where a frame stands in its session.
struct Placement {
    enum class Kind {
        first,        ///< First frame of the session: index 0.
        next,         ///< One after the frame before.
        after_gap,    ///< `missing` samples were lost before it.
        duplicate,    ///< Same counter as the frame before: not a new sample.
        anomaly,      ///< The counter fits no sample of this session; the frame is not placed.
        new_session,  ///< The counter disagrees with elapsed time: the device restarted.
    };
    Kind kind = Kind::first;
    std::int64_t index = 0;    ///< Meaningful for first, next, after_gap.
    std::int64_t missing = 0;  ///< Samples lost before this one; > 0 only for after_gap.
};

/// COUNT rises by `count_step` a frame, modulo 65536.  An index is therefore known from it modulo
/// the period 65536 / gcd(count_step, 65536): 4096 samples at 50 Hz.
///
/// Elapsed time is measured from the least delayed frame of the last minutes, not from the frame
/// before, which may have come late.  An index agrees with it within 1 s + 100 ppm of the time
/// since the last placed frame.
///
/// Contiguous: the difference to the last placed frame decides.  One that is no multiple of the
/// step, or a step back by up to 4096 ticks, is a loss longer than a wrap if that agrees with
/// elapsed time, else an anomaly.  A loss right behind frames that came more than 10 s late is what
/// a receiver dropped while the host did not read: there elapsed time decides first, if it agrees.
///
/// Not contiguous: of the indices that fit the counter, the one nearest the prediction, if it
/// agrees; otherwise, when the counter goes on with at most 1 s missing, the bytes were merely late
/// (on scaled time a host's pause is minutes); otherwise a new session.  A counter that goes on
/// exactly is always next: one outage in `period` that is longer than the period is misread so.
///
/// After an anomaly or a duplicate the state is what it was; a second anomalous frame that follows
/// the first by one step is a new session, so that a restarted counter cannot block for ever.
/// After new_session the caller starts with a new SampleIndex.
class SampleIndex {
public:
    /// @param count_step  ticks per frame, > 0.  @param rate  nominal output rate, > 0.
    SampleIndex(std::uint16_t count_step, Hertz rate);

    /// @param count       the frame's COUNT.
    /// @param contiguous  too few bytes were skipped, and too short a silence passed since the
    ///                    last frame, for the counter to wrap.
    /// @param arrival     host time of the frame's last byte.
    [[nodiscard]] Placement place(std::uint16_t count, bool contiguous, RawTime arrival);

private:
    [[nodiscard]] RawTime start_of(std::int64_t index, RawTime arrival) const;
    [[nodiscard]] bool was_late() const;
    [[nodiscard]] std::optional<std::int64_t> advance_by_time(std::uint16_t difference,
                                                              RawTime arrival) const;
    Placement accept(std::int64_t advance, std::uint16_t count, RawTime arrival);
    Placement refuse(std::uint16_t count);

    std::uint16_t count_step_;
    double rate_hz_;
    std::int64_t period_;  // samples after which index and counter agree again
    std::optional<std::int64_t> last_index_;
    std::uint16_t last_count_ = 0;
    RawTime last_arrival_;
    std::optional<std::uint16_t> anomalous_count_;
    RawTime earliest_start_;         // of the window before this one and this one
    RawTime window_earliest_start_;  // of this one
    std::int64_t window_first_ = 0;
};

}  // namespace a351::timing
