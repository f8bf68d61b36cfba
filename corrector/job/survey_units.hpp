#pragma once

#include <vector>

#include "corrector/job/survey_file.hpp"

namespace a351::corrector::job {

/// Divides a survey whose set-ups are of several sensors into one survey for each sensor, which
/// adjust_jointly() puts together.  Each has its own constant and thermal response, and the
/// calibration if that is of its sensor.
/// @return the survey itself if it has one sensor, or if its small files cannot be read, which
///         read_survey() reports; else one for each sensor, by the end of its last set-up, with the
///         serial number after the name.
[[nodiscard]] std::vector<SurveyFile> by_unit(const SurveyFile& survey);

}  // namespace a351::corrector::job
