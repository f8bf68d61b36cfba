#pragma once
/// @file
/// Options of the correction of a survey.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "corrector/adjustment/prior.hpp"
#include "corrector/adjustment/term.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector::model {

/// Greatest degree of the drift of a loop.  Reason: spring gravimeters are adjusted with a cubic
/// drift at most; a higher degree follows the readings.
inline constexpr int kGreatestDriftDegree = 3;

/// Options of a network.
struct NetworkOptions {
    /// Standard deviation of a reference that has none of its own, mGal.  Default: typical of gravity
    /// networks, and a hundredth of the error of this sensor.  It must be above 0 (not checked).
    double datum_sd_mgal = 0.01;
    /// True: the admittance of the air pressure is an unknown; the readings are not reduced for it.
    bool fits_admittance = false;
    int drift_degree = 1;  ///< 0 to kGreatestDriftDegree; powers of t - t0.
};

/// Options of a correction.
///
/// correct_survey() checks `model`, `base` and `datum`.  The other members are not checked.
/// Each member has an initialiser, so that a caller can name those that it sets.
struct SurveyOptions {
    std::string model = "auto";  ///< One of model_names().
    std::string base = {};       ///< Station of the drift step; empty: that of the first row.
    /// Stations whose reference is held; empty: all that have one.
    std::vector<std::string> datum = {};
    std::vector<adjustment::Step> steps = {};  ///< In order of time; `paper` ignores them.
    /// True: flagged rows are not in the fit.  Excluded rows never are.
    bool use_flags = true;
    NetworkOptions network = {};  ///< Options of `network`.
    std::uint64_t seed = 1;       ///< Seed of the bootstrap over stations.
    /// Priors of the linear models and the network; `paper` uses none, and `day` refuses those of slopes.
    adjustment::Priors priors = {};
    /// Calibration of the unit.  correct_survey() uses it only as prior of `day`; for other models
    /// call correct_with_calibration().
    std::optional<unit::Calibration> calibration = {};
};

}  // namespace a351::corrector::model
