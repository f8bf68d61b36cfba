#pragma once
/// @file
/// Closures: differences between two readings of one station.  Without noise, drift and temperature
/// effects they would be 0.

#include <cstddef>
#include <optional>
#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// The difference `later` minus `earlier` of two readings of one station, after each correction.
struct Closure {
    std::size_t earlier = 0;  ///< Index into the rows.
    std::size_t later = 0;
    double hours = 0.0;  ///< Time between the readings, h.
    MilliGal before;     ///< Difference without any correction.
    MilliGal after_tide, after_temperature, after_rate;
    MilliGal after_all;  ///< After drift and all other corrections of the model.
    /// Drift that would explain after_rate.  Absent between set-ups of one stay, which are too
    /// close in time.
    std::optional<double> drift_mgal_per_h;
};

/// Returns all pairs of readings of each station, stations in the order of their first reading,
/// pairs in order of time.  Each set-up of a stay is a reading.
[[nodiscard]] std::vector<Closure> close_stations(const SurveyCorrection& result);

/// Root mean squares of the differences after every step.
struct ClosureRms {
    MilliGal before, after_tide, after_temperature, after_rate, after_all;
};

/// Returns the root mean squares over all pairs; std::nullopt without a pair.
[[nodiscard]] std::optional<ClosureRms> rms_of(const std::vector<Closure>& closures);

}  // namespace a351::corrector
