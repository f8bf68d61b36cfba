#pragma once
/// @file
/// Figures that describe an occupation within its interval.

#include <cstddef>
#include <optional>
#include <span>

#include "protocol/core/time_series.hpp"
#include "protocol/core/units.hpp"

namespace a351::corrector {

/// Arithmetic mean; NaN of an empty span.  Summed about the first value: keeps 1e-9 of 980,000.
[[nodiscard]] double mean(std::span<const double> values);

/// Standard error of the mean of `values` from the scatter of the means of blocks, which covers
/// noise that is correlated over less than a block.  An incomplete block at the end is left out.
/// @return std::nullopt for fewer than two blocks.
[[nodiscard]] std::optional<double> block_standard_error(std::span<const double> values,
                                                         std::size_t block_size);

enum class TemperatureShape {
    monotone,   ///< From first to last it covers at least 0.8 of its range.
    half_wave,  ///< It comes back once: what it does to the mean is not averaged out.
    turning,    ///< It comes back more than once.
};

struct TemperatureSummary {
    DegC mean;
    double slope_degc_per_h = 0.0;                        ///< By least squares.
    DegC range;                                           ///< Largest less smallest.
    TemperatureShape shape = TemperatureShape::monotone;  ///< Of the means of one minute.
};

/// Describes the samples first..last, both included; missing ones (NaN) are left out.
/// @return std::nullopt for fewer than two valid samples.
[[nodiscard]] std::optional<TemperatureSummary> summarise_temperature(
    const TimeSeries<DegC>& temperature, std::size_t first, std::size_t last);

struct AxisSummary {
    StandardGravity mean;
    MilliGal rms;  ///< About the trend: vibration and sensor noise.
};

/// Describes the samples of `raw` from trend sample `first` to `last`, both included.  Between its
/// samples the trend is a straight line; samples without trend (NaN) are left out.
///
/// Precondition: the trend has the start of `raw` and 1 / ratio of its rate; last < trend.size().
[[nodiscard]] AxisSummary summarise_axis(const TimeSeries<StandardGravity>& raw,
                                         const TimeSeries<StandardGravity>& trend,
                                         std::size_t ratio, std::size_t first, std::size_t last);

}  // namespace a351::corrector
