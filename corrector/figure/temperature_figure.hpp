#pragma once
/// @file
/// The temperature of a survey day.

#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/model/survey_correction.hpp"
#include "corrector/reading/temperature_course.hpp"

namespace a351::corrector {

/// Returns the figure of the day's temperature with the readings; without a course, of the readings
/// only.
[[nodiscard]] Figure temperature_figure(const SurveyCorrection& result,
                                        const std::vector<MinuteTemperature>& course);

}  // namespace a351::corrector
