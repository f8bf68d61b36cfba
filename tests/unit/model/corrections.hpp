#pragma once
/// @file
/// Corrections of made-up surveys, and single values of them.

#include <algorithm>
#include <string>

#include "corrector/model/survey_correction.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/model/survey_rows.hpp"

namespace a351::corrector::model {

inline SurveyOptions by_model(const std::string& model) { return {.model = model}; }

/// Returns the reading without tide plus all corrections that the row has.
inline double sum_mgal(const CorrectedRow& row) {
    MilliGal sum = row.row.reduced() + row.temperature_correction + row.rate_correction +
                   row.drift_correction + row.tilt_correction_or_zero() +
                   row.scale_correction.value_or(MilliGal(0.0));
    if (const auto* const own = row.as<WholeDayRow>()) sum = sum + own->flicker_correction;
    return sum.value();
}

inline const Coefficient& coefficient(const SurveyCorrection& result, const std::string& name) {
    const auto found = std::ranges::find(result.coefficients, name, &Coefficient::name);
    REQUIRE(found != result.coefficients.end());
    return *found;
}

inline const StationValue& station(const SurveyCorrection& result, const std::string& site) {
    const auto found = std::ranges::find(result.stations, site, &StationValue::site);
    REQUIRE(found != result.stations.end());
    return *found;
}

/// Returns the first remark that begins so, or nothing.
inline std::string remark(const SurveyCorrection& result, const std::string& beginning) {
    for (const std::string& one : result.remarks)
        if (one.starts_with(beginning)) return one;
    return {};
}

}  // namespace a351::corrector::model
