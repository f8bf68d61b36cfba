#pragma once
/// @file
/// The part of an occupation that is averaged.
///
/// The mean of a slow oscillation depends on where the average begins and ends.  An undisturbed
/// record is averaged completely.  Where a disturbance cuts it, the average begins or ends at an
/// extremum.
///
/// First choose_part() cuts the record at pulses, then the trend of this part is computed, then
/// choose_interval() chooses within it:
///
///     const Part part = choose_part(found.disturbed, margin);
///     const auto curve = trend_of(samples part.first ... part.last);
///     const Interval in = choose_interval(curve, part.disturbed_first, part.disturbed_last);
///     // averaged: samples part.first + in.first ... part.first + in.last
///
/// The rules are explained in decimation.md, "Interval".  Both functions are pure.

#include <cstddef>
#include <span>
#include <vector>

namespace a351::corrector::reading {

/// Samples first..last, both included.  No pulse (see choose_part()) is between them.
/// Indices are those of the vector given to choose_part(); first <= last.
struct Part {
    std::size_t first = 0;
    std::size_t last = 0;
    bool disturbed_first = false;  ///< A disturbance is next to the first sample.
    bool disturbed_last = false;   ///< A disturbance is next to the last sample.
    bool split = false;            ///< Pulses cut the record; this is the longest part.
};

/// Returns the longest part of a record between pulses.
///
/// A pulse is a disturbed sample farther than `margin` from both ends.  The record is split at
/// pulses, and the longest part is kept (the earliest of several).  A side of the part next to a
/// pulse is disturbed.  A side at an end of the record is disturbed if a sample within `margin` of
/// it is.
///
/// The part has at least one sample, because the outermost samples are never pulses.
/// It may contain disturbed samples within `margin` of an end of the record; replace them with
/// despike() before the trend is computed.  If 2 margin + 2 >= n, nothing is a pulse and the part
/// is the whole record.
///
/// @param disturbed  (n) from find_disturbances(), n >= 1, which is asserted.
/// @param margin     samples, >= 0; 60 s for an occupation.
/// @return the part; `split` is true if it is not the whole record.
[[nodiscard]] Part choose_part(const std::vector<bool>& disturbed, std::size_t margin);

/// Samples first..last of the part, both included.
/// Indices begin with 0 at the first sample of the part; first <= last, and first < last if the
/// part has two samples or more.
struct Interval {
    std::size_t first = 0;
    std::size_t last = 0;
    bool fallback = false;  ///< A fallback was used, because the curve has too few extrema.
};

/// Chooses the interval from the extrema of the trend curve.  A disturbed side is put at a
/// comparable phase of the slow oscillation, away from the disturbance.
///
/// 1. An undisturbed side is at the end of the curve.
/// 2. A disturbed side is at the second extremum from its end.  With only one extremum it is there;
///    without extrema it is at the end (both are fallbacks).
/// 3. If at most one sample is left, the interval is from the first extremum to the last.  With
///    fewer than two extrema it is the whole curve (both are fallbacks).
///
/// The position of a flat extremum is its middle, rounded down
/// (tests/unit/reading/interval_test.cpp).
///
/// With both sides disturbed and four extrema or more, it is from the second to the last but one.
/// A fallback is no error; flag the value, because the phases at the ends are not comparable then.
///
/// @param curve  (n) trend curve of one part, any unit, finite; n >= 1, which is asserted.  The
///               count of extrema is exact, so a noisy curve would give a side near its end.
/// @param disturbed_first, disturbed_last  from choose_part().
[[nodiscard]] Interval choose_interval(std::span<const double> curve, bool disturbed_first,
                                       bool disturbed_last);

}  // namespace a351::corrector::reading
