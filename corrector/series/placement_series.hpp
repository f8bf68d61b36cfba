#pragma once
/// @file
/// Scatter of repeated set-ups at one point (corrector/methods.md, "Calibration").
///
/// The box is lifted, set down and levelled again some twenty times in an hour.  What differs from set-up
/// to set-up, and is not tilt, temperature, flicker or white noise, is placement.
///
///     const PlacementSeries first = measure_placement(read_first, calibration, "monday");
///     calibration.placement = combine({first, second});

#include <string>
#include <vector>

#include "corrector/reading/occupation_rows.hpp"
#include "corrector/whole_day/day_noise.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector::series {

/// Placement from one series, and the facts about the series.
struct PlacementSeries {
    unit::Placement placement;
    std::size_t set_ups = 0;    ///< Number of set-ups used.
    whole_day::DayNoise noise;  ///< Most likely noise of the series.
};

/// Measures the placement.
///
/// The whole-day model with gravity held is fitted to the series.  The value is the most likely one,
/// and its limits follow from the curvature of the likelihood; both contain the usual prior of
/// placement, 1.2 mGal within a factor of 2.  Flagged and excluded set-ups are not used.
///
/// Accuracy (placement_series_test.cpp): in thirty made-up series of twenty set-ups of three minutes, with
/// placements of 0.6 to 2.4 mGal and flicker of 1.2 mGal, the rms of ln(found / true) is 0.19, and all
/// limits contain the truth.
/// @param read    rows and record of the series.  Flagged set-ups need bins too.
/// @param known   axis biases and thermal response of the unit, if they were measured.
/// @param origin  name of the series, for messages.
/// @throws InputError  if set-ups are at several points or fewer than eight, if model::day_refusal() has a
///                     reason, or if the series does not determine the placement.
[[nodiscard]] PlacementSeries measure_placement(const reading::OccupationRows& read,
                                                const unit::Calibration& known,
                                                const std::string& origin);

/// Returns the mean of independent measurements of the logarithm, with weights from their errors.
///
/// The usual prior, which each of them contains, is counted once.  Series that disagree do not widen the limits.
/// @param series  at least one.
[[nodiscard]] unit::Placement combine(const std::vector<PlacementSeries>& series);

}  // namespace a351::corrector::series
