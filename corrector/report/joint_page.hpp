#pragma once
/// @file
/// joint.html: several survey days side by side.

#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// A day that was asked for: corrected, or why it is not.
struct JointDay {
    std::string name;
    std::string folder;                        ///< Of its result, beside the page.
    const SurveyCorrection* result = nullptr;  ///< Null: not corrected.
    std::string trouble = {};                  ///< Why not.
};

/// How far values of stations seen on several days differ from day to day.
struct DayScatter {
    double rms_mgal = 0.0;  ///< About the mean of each station, with the degrees of freedom.
    std::size_t dof = 0;    ///< Days of each such station, less one.
    std::optional<double> expected_mgal;  ///< RMS of their u; absent where one has none.
};

/// @return std::nullopt when no station was seen twice.
[[nodiscard]] std::optional<DayScatter> scatter_of_days(const std::vector<SurveyCorrection>& days);

/// The page: days with their scores and a link to their reports, joint stations with what each day
/// differs from them.  Alone in its file.
[[nodiscard]] std::string joint_html(const std::vector<JointDay>& days);

}  // namespace a351::corrector
