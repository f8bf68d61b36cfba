#pragma once
/// @file
/// The 16-bit COUNT of the frames -> an index that never wraps.  While bytes are contiguous, the
/// counter alone decides; after a loss, elapsed time chooses among the indices that match the
/// counter.
///
///     SampleIndex index(count_step, rate);
///     const Placement placement = index.place(count, contiguous, arrival);
///     if (placement.kind == Placement::Kind::new_session) {
///         index = SampleIndex(count_step, rate);  // the same frame is its first one
///         ...
///     }

#include <cstdint>
#include <optional>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::timing {

/// Position of a frame in its session.
///
/// The caller stores the sample after `first`, `next` and `after_gap`.  It drops the frame after
/// `duplicate` and `anomaly`, and begins a new session with it after `new_session`.
struct Placement {
    enum class Kind {
        first,        ///< First frame of the session: index 0.
        next,         ///< Directly after the frame before.
        after_gap,    ///< `missing` samples were lost before it.
        duplicate,    ///< Same counter as the frame before: not a new sample.
        anomaly,      ///< The counter matches no sample of this session; the frame is not placed.
        new_session,  ///< The counter disagrees with elapsed time: the device restarted.
    };
    Kind kind = Kind::first;
    std::int64_t index = 0;    ///< Sample index from 0; defined for first, next, after_gap.
    std::int64_t missing = 0;  ///< Samples lost before this one; > 0 only for after_gap.
};

/// Gives each frame its sample index.  COUNT rises by `count_step` per frame, modulo 65536, so it
/// determines the index modulo the period 65536 / gcd(count_step, 65536): 4096 samples at 50 Hz.
///
/// Elapsed time is measured from the least delayed frame of the last minutes, because the frame
/// before may have come late.  An index agrees with elapsed time within 1 s + 100 ppm of the time
/// since the last placed frame.
///
/// Contiguous frames: the difference from the last placed frame decides.  It may be no multiple of
/// the step, or a step back by up to 4096 ticks.  Then the loss is longer than a wrap if this
/// agrees with elapsed time; otherwise it is an anomaly.  After frames that came more than 10 s
/// late, bytes were lost in the receiver while the host did not read.  Then elapsed time decides
/// first, if it agrees.
///
/// Other frames: of the indices that match the counter, the one nearest to elapsed time, if it
/// agrees.  Otherwise, if the counter continues with at most 1 s missing, the bytes were only late
/// (on scaled time a pause of the host is minutes).  Otherwise it is a new session.
///
/// A counter that continues exactly is always `next`.  So one in `period` outages longer than the
/// period is not seen.
///
/// After an anomaly or a duplicate the state is unchanged.  A second anomalous frame that follows
/// the first by one step is a new session, so that a restarted counter cannot block for ever.
/// After new_session the caller must start with a new SampleIndex.
///
/// Deterministic: positions depend only on the frames before.  O(1) in time and memory for a frame
/// that follows the one before.  A layout without COUNT cannot use this class.
///
/// Accuracy (sample_index_test.cpp): the index is exact after outages of up to 10 h at 50 to 1000
/// Hz with arrivals up to 0.8 s late, and with an oscillator 10 ppm off.  A counter that restarted
/// at random is taken for a gap in 2.4 to 3.7 % of all cases at 50 Hz.
class SampleIndex {
public:
    /// Begins a session: the first frame placed gets index 0.
    /// @param count_step  COUNT increment per frame, > 0; not checked.
    /// @param rate        nominal output rate, > 0; not checked.
    SampleIndex(std::uint16_t count_step, Hertz rate);

    /// Returns the position of the next frame.
    /// @param count       COUNT of the frame.
    /// @param contiguous  true if the bytes skipped and the silence since the last frame are too
    ///                    short for the counter to wrap.
    /// @param arrival     host time of the last byte of the frame; time that the host slept counts.
    ///                    It may be late, but not early.
    [[nodiscard]] Placement place(std::uint16_t count, bool contiguous, RawTime arrival);

private:
    [[nodiscard]] RawTime start_of(std::int64_t index, RawTime arrival) const;
    [[nodiscard]] std::optional<std::int64_t> advance_by_time(std::uint16_t difference,
                                                              RawTime arrival) const;
    Placement accept(std::int64_t advance, std::uint16_t count, RawTime arrival);
    Placement refuse(std::uint16_t count);

    std::uint16_t count_step_;
    double rate_hz_;
    std::int64_t period_;  ///< Samples after which the counter repeats.
    std::optional<std::int64_t> last_index_;
    std::uint16_t last_count_ = 0;
    RawTime last_arrival_;
    std::optional<std::uint16_t> anomalous_count_;
    RawTime earliest_start_;         ///< Least start in this window and the one before.
    RawTime window_earliest_start_;  ///< Least start in this window.
    std::int64_t window_first_ = 0;  ///< First sample of this window.
};

}  // namespace a351::timing
