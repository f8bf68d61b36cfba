#pragma once
/// @file
/// Which readings of a survey to trust and which to repeat.

#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

enum class Grade {
    trust,
    care,    ///< Usable; something about it is unusual.
    repeat,  ///< Its value should not be relied on.
};

struct ReadingGrade {
    Grade grade = Grade::trust;
    std::vector<std::string> reasons;  ///< For a person, without the reading's name.
};

/// One grade per row.  A temperature that was not steady (temperature_doubt()) means `repeat` when the model has no term for its rate,
/// else `care`; a reading that the operator marked means `repeat` unless it is in the fit.
[[nodiscard]] std::vector<ReadingGrade> grade_readings(const SurveyCorrection& result);

/// Whether a reading of this station is graded `trust`.
[[nodiscard]] bool has_trusted_reading(const SurveyCorrection& result,
                                       const std::vector<ReadingGrade>& grades,
                                       const std::string& site);

}  // namespace a351::corrector
