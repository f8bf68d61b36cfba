#pragma once
/// @file
/// The noise of a record at one point: spectrum, Allan deviation, a model of three noises, and how
/// long a stay gains from a longer average.
///
///     const RecordNoise noise = record_noise(segment.quantity, step_s);
///     if (noise.useful) noise.useful->averaging_s;  // a longer average scatters hardly less

#include <optional>
#include <vector>

#include "corrector/noise/allan_deviation.hpp"
#include "corrector/noise/spectral_density.hpp"

namespace a351::corrector::noise {

/// Time between two stays that are compared.  Reason: from one station to the next and back it is an
/// hour or more, in which flicker, drift and the cycle of the oven act.
inline constexpr double kBetweenStays_s = 3600.0;

/// Scatter of averages kBetweenStays_s apart: the rms of their differences, divided by sqrt(2).
struct StayScatter {
    double averaging_s = 0.0;
    double scatter_mgal = 0.0;
};

struct RecordNoise {
    std::vector<Density> spectrum;
    AllanAnalysis allan;
    /// Averages of 1, 2, 4 ... samples up to kBetweenStays_s; empty for a record shorter than three
    /// times that.
    std::vector<StayScatter> stays;
    /// Shortest of these times whose scatter is within a tenth of the least; absent without them.
    std::optional<StayScatter> useful;
};

/// Computes the noise of a record.
/// @param values  (n) mGal, finite, n >= 64.
/// @param step_s  time between samples.
[[nodiscard]] RecordNoise record_noise(const std::vector<double>& values, double step_s);

}  // namespace a351::corrector::noise
