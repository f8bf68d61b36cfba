#pragma once
/// @file
/// The line that bounds arrivals from below, and how well they determine it.

#include <cstdint>
#include <optional>
#include <span>

#include "protocol/core/utc_time.hpp"

namespace a351::timing {

/// What 2 s of data say: y = arrival - due.
struct ArrivalBlock {
    std::int64_t number = 0;  ///< Of the 2 s since index 0.
    Nanoseconds due{0};       ///< index / rate of the sample with the least y.
    Nanoseconds least_y{0};
    std::optional<Nanoseconds> spacing{};  ///< Largest step in the sorted y, late ones apart.
};

/// Of the seconds of the raw clock per nominal second of data, less 1.
struct RateLimits {
    /// Device 10 ppm (M-A352AD10 data sheet, electrical specifications) + host crystal 100 ppm,
    /// twice what PC crystals are usually specified to.
    static constexpr double kLargest = 110e-6;

    double least = -kLargest;
    double largest = kLargest;
};

struct EdgeFit {
    Nanoseconds y{0};  ///< Of a frame that nothing delayed.
    double skew = 0.0;
    Nanoseconds uncertainty{0};     ///< 95 %.
    double skew_uncertainty = 0.0;  ///< Half the range of rates that the arrivals allow.
};

/// Delays are never negative, so the truth lies below the cloud of
///
///     y = arrival - index / rate
///
/// and, while the host is not busy, no deeper below its lowest points than the delay that no frame
/// escapes.  Of every 2 s of data the least y counts.  The true line L is taken to obey
///
///     y - D <= L <= y   at every point that is kept,   slope of L within limits
///
/// and L is estimated as the middle of what these leave; half their distance is the uncertainty.
/// Both limits are found from the two convex hulls, to 2 us.
///
/// D.  An adapter that delivers every T delays frames of period P by values spaced by the common
/// divisor of T and P (16 and 20 ms: 4 ms), whose phase moves only with the drift between the two
/// oscillators; up to one spacing can stay hidden for hours.  The spacing is seen within each 2 s:
/// D = its usual value + 1 ms for the polling of a full-speed bus + 0.3 ms for the wander of the
/// rates.
/// Without a spacing D is what the points need; the uncertainty then still allows for 1 ms of timer
/// and 1 ms of polling, which nothing would show if they kept step with the sensor.
///
/// Points more than D + 1 ms above the lowest line are the host's pauses and take no part.
///
/// Accuracy (clock_days_test, 50 Hz, seeds that were not looked at before; of all errors 99 %): 16 ms
/// timer, after 10 min, 0.47 ms, in step with the sensor 2.1 ms; 1 ms timer 0.26 ms.  The test asks
/// for 1.0, 2.5 and 0.3 ms, and that the stated uncertainty covers 95 %.
///
/// Source: E. Olson, "A passive solution to the sensor synchronization problem", IROS 2010 (the
/// bound from one side).  The bound from the other side is ours.
///
/// @param blocks  at least one, rising.  @param at  where, on the scale of `due`.
[[nodiscard]] EdgeFit fit_edge(std::span<const ArrivalBlock> blocks, Nanoseconds at,
                               Nanoseconds sample_period, RateLimits limits);

}  // namespace a351::timing
