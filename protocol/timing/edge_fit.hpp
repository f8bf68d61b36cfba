#pragma once
/// @file
/// The line that bounds arrivals from below, and its uncertainty.
///
/// ArrivalEdge collects the blocks and calls fit_edge(); other code uses ArrivalEdge.  A
/// least-squares line would be of no use here: it lies in the middle of the delays, which change
/// with the host.

#include <cstdint>
#include <optional>
#include <span>

#include "protocol/core/utc_time.hpp"

namespace a351::timing {

/// Summary of 2 s of data; y = arrival - due, due = index / rate.  The zero of y is the caller's
/// choice, the same for all blocks.
struct ArrivalBlock {
    std::int64_t number = 0;               ///< Number of the block from index 0; not used here.
    Nanoseconds due{0};                    ///< Due time of the sample with the least y.
    Nanoseconds least_y{0};                ///< Least y of the block.
    std::optional<Nanoseconds> spacing{};  ///< Largest step in the sorted y, latest tenth excluded.
};

/// Limits of the skew: seconds of the raw clock per nominal second of data, less 1.
struct RateLimits {
    /// Largest magnitude of the skew: device 10 ppm (M-A352AD10 data sheet, electrical
    /// specifications) + host crystal 100 ppm, twice the usual specification of PC crystals.
    static constexpr double kLargest = 110e-6;

    /// Least and largest skew that the line may have, dimensionless.  The default knows nothing of
    /// the two oscillators but their specifications.
    double least = -kLargest;
    double largest = kLargest;
};

/// The line at one due time.
struct EdgeFit {
    Nanoseconds y{0};               ///< y of a frame that nothing delayed.
    double skew = 0.0;              ///< Slope of y over due: rate of the raw clock, less 1.
    Nanoseconds uncertainty{0};     ///< Uncertainty of `y`, 95 %.
    double skew_uncertainty = 0.0;  ///< Half the range of slopes that the arrivals allow.
};

/// Estimates the line of arrivals without delay from the least y of each block,
///
///     y = arrival - index / rate
///
/// Delays are never negative, so the true line L lies below all points.  While the host is not
/// busy, it lies at most D below the lowest ones, where D is the delay that no frame escapes:
///
///     y - D <= L <= y   at every point that is kept,   slope of L within `limits`
///
/// The estimate is the middle of all lines that these conditions allow.  The uncertainty is the
/// distance to the farthest of them + 0.2 ms.  On a busy host points can exceed D; this excess is
/// added.
/// Both bounds are found from the two convex hulls of the points, to 2 us over 900 s.
///
/// The hidden delay D: an adapter that delivers every T delays frames of period P by values spaced
/// by the common divisor of T and P (16 and 20 ms: 4 ms).  Their phase moves only with the drift
/// between the two oscillators, so up to one spacing can stay hidden for hours.  The spacing is
/// visible within each block; D = its usual value + 1 ms for the polling of a full-speed bus +
/// 0.3 ms for the wander of the rates.
/// Without a spacing the height of the points decides D: nothing if they do not scatter, 2 ms for a
/// timer of 1 ms and a polling of 1 ms, or 1 ms if only one of them shows.  It shows alone if fewer
/// than 1 point in 20 lies more than 1.3 ms above the line, in 600 s or more.  The uncertainty
/// includes both in any case, because they stay invisible while they are in step with the sensor.
///
/// Points more than D + 1 ms above the lowest line (3.3 ms without a spacing) are pauses of the
/// host and are ignored.  As long as no block has a spacing, 16 ms are added to the uncertainty:
/// the latency timer of an adapter as delivered.
///
/// Accuracy (clock_days_test.cpp, 50 Hz, seeds not used in development, 99 % of all errors): behind
/// a 16 ms timer 0.47 ms after 10 min, 2.1 ms if it is in step with the sensor; behind a 1 ms timer
/// 0.26 ms with polling, 0.9 ms if in step.  The test requires 1.0, 2.5, 0.3 and 2.5 ms, and that the
/// stated uncertainty covers 95 %.  Behind a pure 1 ms timer 0.11 ms, 0.96 ms if it runs within 3 ppm of
/// the sensor (pure_timer_test.cpp, an emulator of its own; required: 0.3 and 1.1 ms).
///
/// Source: E. Olson, "A passive solution to the sensor synchronization problem", IROS 2010 (the
/// bound from one side).  The bound from the other side is this project's.
///
/// Cost: O(n) for n blocks; allocates O(n).  Deterministic, no state.
///
/// @param blocks         at least one, in rising order of `due`; not checked.
/// @param at             due time at which the line is given; may lie outside the blocks.
/// @param sample_period  nominal time from sample to sample.
/// @param limits         finite, least <= largest; not checked.
/// @return the line at `at`.  With one block, its slope is the middle of `limits`.
[[nodiscard]] EdgeFit fit_edge(std::span<const ArrivalBlock> blocks, Nanoseconds at,
                               Nanoseconds sample_period, RateLimits limits);

}  // namespace a351::timing
