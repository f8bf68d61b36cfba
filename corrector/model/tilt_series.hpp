#pragma once
/// @file
/// Biases of the horizontal axes from a series of tilted set-ups at one point
/// (corrector/methods.md, "Calibration").

#include <string>
#include <vector>

#include "corrector/reading/occupation_rows.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector {

struct TiltSeries {
    AxisBias bias;
    std::size_t set_ups = 0;                                      ///< Measured from.
    std::array<double, 2> least_tilt_deg{}, greatest_tilt_deg{};  ///< Of x and y.
    double temperature_range_degc = 0.0;                          ///< Between set-ups.
    double placement_mgal = 0.0;  ///< Scatter of set-ups that the fit found.
};

/// The whole-day model with gravity held, fitted to | mean vector - biases | until they no longer
/// change: exact at any tilt.  The bias of the vertical axis comes from the site's gravity.
/// @param origin  of the series, for messages.
/// @throws InputError  in words, what the series lacks: one point, six set-ups, both axes tilted by
///                     half a degree to both sides and not only together, an even temperature.
[[nodiscard]] TiltSeries measure_axis_bias(const OccupationRows& read, const std::string& origin);

/// The weighted mean of independent measurements.
/// @param series  at least one.
[[nodiscard]] AxisBias combine(const std::vector<TiltSeries>& series);

}  // namespace a351::corrector
