#pragma once
/// @file
/// What two readings of one station differ by: without noise, drift and temperature it would be 0.

#include <cstddef>
#include <optional>
#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Two readings of one station, `later` less `earlier`, as one correction after the other is added.
struct Closure {
    std::size_t earlier = 0;  ///< Index into the rows.
    std::size_t later = 0;
    double hours = 0.0;  ///< Between them.
    MilliGal before;     ///< As read.
    MilliGal after_tide, after_temperature, after_rate;
    MilliGal after_all;  ///< After drift and whatever else the model corrects.
    /// The drift that would explain after_rate; absent between set-ups of one stay, which are too
    /// close in time to tell.
    std::optional<double> drift_mgal_per_h;
};

/// All pairs of readings of a station, stations in the order of their first reading, pairs by time;
/// set-ups of one stay are readings of their own.
[[nodiscard]] std::vector<Closure> close_stations(const SurveyCorrection& result);

/// Root mean squares of the differences after every step.
struct ClosureRms {
    MilliGal before, after_tide, after_temperature, after_rate, after_all;
};

/// @return std::nullopt without a pair.
[[nodiscard]] std::optional<ClosureRms> rms_of(const std::vector<Closure>& closures);

}  // namespace a351::corrector
