#pragma once
/// @file
/// joint.html: several survey days side by side.

#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// One day of the survey: its result, or the reason why there is none.
struct JointDay {
    std::string name;
    std::string folder;                        ///< Folder of its result, next to the page.
    const SurveyCorrection* result = nullptr;  ///< Result; null if not corrected.
    std::string trouble = {};                  ///< Reason if not corrected.
};

/// Scatter from day to day of stations measured on several days.
struct DayScatter {
    double rms_mgal = 0.0;  ///< RMS about the mean of each station, divisor `dof`.
    std::size_t dof = 0;    ///< Degrees of freedom: the sum over stations of days minus one.
    std::optional<double> expected_mgal;  ///< RMS of the values' u; absent if a value has no u.
};

/// Computes the scatter from day to day.
/// @return std::nullopt if no station was measured on two days.
[[nodiscard]] std::optional<DayScatter> scatter_of_days(const std::vector<SurveyCorrection>& days);

/// Returns the page: days with their scores and links to their reports, and the joint stations with
/// the difference of each day.  It needs no other file.
[[nodiscard]] std::string joint_html(const std::vector<JointDay>& days);

}  // namespace a351::corrector
