#pragma once

#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/model/survey_correction.hpp"
#include "corrector/reading/temperature_course.hpp"

namespace a351::corrector {

/// The temperature of the day with the readings.  Without a course the readings alone.
[[nodiscard]] Figure temperature_figure(const SurveyCorrection& result,
                                        const std::vector<MinuteTemperature>& course);

}  // namespace a351::corrector
