#pragma once
/// @file
/// A plan of one known and three unknown stations, with a return to the known one.

#include "corrector/design/expected_errors.hpp"
#include "corrector/design/plan.hpp"
#include "corrector/design/planned_unit.hpp"
#include "tests/support/catch.hpp"

namespace a351::corrector::design {

inline std::vector<text::Site> made_up_sites() {
    const auto site = [](const char* name, double north, std::optional<MilliGal> gravity) {
        return text::Site{name, Degrees(140.0), Degrees(36.0 + north), Metres(100.0), gravity};
    };
    return {site("A", 0.0, MilliGal(979800.0)), site("B", 0.01, std::nullopt),
            site("C", 0.02, std::nullopt), site("D", 0.03, std::nullopt),
            site("K", 0.021, MilliGal(979810.0))};
}

/// Returns visits each half hour, in the order of the names.
inline Plan made_up_plan(const std::string& names = "ABCDA", int set_ups = 1,
                         double minutes_each = 12.0) {
    Plan plan;
    UtcTime start = *parse_rfc3339("2026-05-01T00:00:00Z");
    for (const char name : names) {
        plan.push_back({std::string(1, name), start, set_ups, minutes_each});
        start += std::chrono::minutes(30);
    }
    return plan;
}

/// Returns a unit whose response and drift are known, so that only its noise is left.
inline PlannedUnit known_unit(const whole_day::DayNoise& noise) {
    PlannedUnit unit = usual_unit();
    unit.noise = noise;
    const auto constant = whole_day::DayPriors::place_of(whole_day::DayTerm::constant);
    for (Eigen::Index k = 0; k < whole_day::DayPriors::kCount; ++k)
        if (k != constant) unit.priors.factor(k, k) = 1e-9;
    return unit;
}

inline MilliGal u_of(const ExpectedErrors& errors, const std::string& site) {
    return std::ranges::find(errors.stations, site, &ExpectedStation::site)->u;
}

}  // namespace a351::corrector::design
