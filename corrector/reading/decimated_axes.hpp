#pragma once
/// @file
/// Samples of a set-up, and their decimation before any average.
///
/// The axes are decimated before the norm, so that vibration does not enter it.  The filter is that
/// of design_decimation(kDecimationFactor).
///
///     const DecimatedAxes axes = decimate_axes(record);
///     const TimeSeries<MilliGal> level = gravity_series(record, axes, NormOrder::decimate_first);
///
/// Output k is centred on raw sample 100 k and has its time.  A complete record of n samples has
/// ceil(n / 100) outputs, of which the first five and the last four or five are NaN.

#include <cstddef>

#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"
#include "protocol/signal/decimation.hpp"
#include "protocol/signal/norm.hpp"

namespace a351::corrector::reading {

/// Decimation before an average: two stages by 10, one value per 100 samples (2 s at 50 Hz).
/// Source of the factor 10: decimation.md.
inline constexpr int kDecimationFactor = 10;
inline constexpr int kDecimationStages = 2;
inline constexpr std::size_t kDecimationRatio = 100;
static_assert(kDecimationFactor * kDecimationFactor == kDecimationRatio && kDecimationStages == 2);

/// Samples recorded at a site; missing ones are NaN.  The axes cover the occupation only.  The
/// temperature may begin earlier and end later, on the same grid of instants.
///
/// Invariant for all users: x, y and z have one start, rate and length.  The axes are in g, with
/// their sign as recorded; z is about 1 g, x and y are near 0.
struct OccupationRecord {
    TimeSeries<StandardGravity> x;  ///< Horizontal axis.
    TimeSeries<StandardGravity> y;  ///< Horizontal axis.
    TimeSeries<StandardGravity> z;  ///< Axis along gravity.
    TimeSeries<DegC> temperature;   ///< Temperature of the sensor, at the rate of the axes.
};

/// Axes at 1 / 100 of the sensor's rate, in g; missing samples NaN.
struct DecimatedAxes {
    TimeSeries<StandardGravity> x, y, z;
};

/// Decimates each axis to 1 / 100 of its rate; an output is NaN if a sample under the filters (451
/// to either side) is missing or beyond the record.
///
/// Each axis is decimated by itself: a sample missing in one axis leaves the others valid.  The
/// axes are not compared here.  Nothing is delayed and no gap is bridged.  A record of fewer than
/// 952 samples has outputs, but none is valid (least_length()).
[[nodiscard]] DecimatedAxes decimate_axes(const OccupationRecord& record);

/// Order of norm and decimation.  With sideways vibration the norm of raw samples is too large by
/// rectification_bias(), and no later filter removes that.
enum class NormOrder {
    decimate_first,  ///< Norm of the decimated axes, without this bias; the default of a survey.
    as_published,    ///< Decimated norm of the raw axes, with this bias; to repeat the publication.
};

/// Returns the magnitude of gravity, sqrt(x^2 + y^2 + z^2), at 1 / 100 of the sensor's rate.
///
/// Accuracy with sideways vibration of 1 Gal rms on both axes (decimated_axes_test.cpp): a mean
/// within 1e-4 mGal with decimate_first; too large by 1.02 mGal with as_published, which
/// rectification_bias() gives to 0.1 %.
/// @param record  raw axes in g; missing samples NaN.  Used by as_published only.
/// @param axes    decimate_axes(record).  Used by decimate_first only.
/// @return mGal; NaN where decimate_axes() has NaN in an axis.
/// @throws std::invalid_argument  the axes differ in start, rate or length.
[[nodiscard]] TimeSeries<MilliGal> gravity_series(const OccupationRecord& record,
                                                  const DecimatedAxes& axes, NormOrder order);

}  // namespace a351::corrector::reading
