#pragma once
/// @file
/// Stations of several survey days.

#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// A station over several survey days.
struct JointStation {
    std::string site;
    std::size_t day_count = 0;
    std::size_t row_count = 0;
    /// Mean of the days, each weighted by 1/u^2; not weighted if a day has no u.
    MilliGal gravity;
    std::optional<MilliGal> u_gravity;  ///< 1 / sqrt(sum 1/u^2), which assumes independent days.
    std::optional<MilliGal> reference;
    std::optional<MilliGal> residual;
};

/// Returns the stations in the order of their first appearance.
[[nodiscard]] std::vector<JointStation> join_days(const std::vector<SurveyCorrection>& days);

/// Returns site, days, rows, gravity, u, reference and residual of a station as text.
[[nodiscard]] std::vector<std::string> joint_cells(const JointStation& station);

/// Returns the stations as joint.csv.
[[nodiscard]] std::string joint_csv(const std::vector<JointStation>& stations);
/// Returns the stations as an aligned table.
[[nodiscard]] std::string joint_text(const std::vector<JointStation>& stations);

}  // namespace a351::corrector
