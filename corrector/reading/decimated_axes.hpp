#pragma once
/// @file
/// Samples of a set-up, and their decimation before any average.

#include <cstddef>

#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"
#include "protocol/signal/decimation.hpp"
#include "protocol/signal/norm.hpp"

namespace a351::corrector {

/// Decimation before an average: two stages by 10, one value for 100 samples, at 50 samples/s every 2 s.
inline constexpr int kDecimationFactor = 10;
inline constexpr int kDecimationStages = 2;
inline constexpr std::size_t kDecimationRatio = 100;
static_assert(kDecimationFactor * kDecimationFactor == kDecimationRatio && kDecimationStages == 2);

/// Samples recorded at a site; missing ones are NaN.  The axes hold the occupation only; the
/// temperature may begin earlier and end later, on the same grid of instants.
struct OccupationRecord {
    TimeSeries<StandardGravity> x;  ///< Horizontal.
    TimeSeries<StandardGravity> y;  ///< Horizontal.
    TimeSeries<StandardGravity> z;  ///< Along gravity.
    TimeSeries<DegC> temperature;
};

/// Axes at 1 / 100 of the sensor's rate.
struct DecimatedAxes {
    TimeSeries<StandardGravity> x, y, z;
};

/// Decimates each axis; NaN where a sample under the filters is missing.
[[nodiscard]] DecimatedAxes decimate_axes(const OccupationRecord& record);

/// Order of norm and decimation.  The norm of samples that vibrate sideways is too large by
/// rectification_bias(), and no later filter takes that away.
enum class NormOrder {
    decimate_first,  ///< Norm of the decimated axes: free of that bias.
    as_published,    ///< Decimated norm of the raw axes.
};

/// Magnitude of gravity at 1 / 100 of the sensor's rate.
/// @param axes  decimate_axes(record).
/// @throws std::invalid_argument  the axes differ in start, rate or length.
[[nodiscard]] TimeSeries<MilliGal> gravity_series(const OccupationRecord& record,
                                                  const DecimatedAxes& axes, NormOrder order);

}  // namespace a351::corrector
