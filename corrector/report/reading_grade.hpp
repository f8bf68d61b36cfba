#pragma once
/// @file
/// Grades of readings: which ones to trust, and which ones to repeat.

#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

enum class Grade {
    trust,   ///< Nothing about it is unusual.
    care,    ///< Usable, but something is unusual.
    repeat,  ///< Not reliable.
};

/// The grade of one reading.
struct ReadingGrade {
    Grade grade = Grade::trust;
    std::vector<std::string> reasons;  ///< Reasons in words, without the reading's name.
};

/// Returns one grade per row.
///
/// A temperature that was not steady (temperature_doubt()) means `care` if the model has a term for
/// its rate, else `repeat`.  A reading that the operator marked means `repeat` unless it is in the
/// fit.  The other rules are in corrector/methods.md, "Report".
[[nodiscard]] std::vector<ReadingGrade> grade_readings(const SurveyCorrection& result);

/// Returns true if a reading of this station is graded `trust`.
[[nodiscard]] bool has_trusted_reading(const SurveyCorrection& result,
                                       const std::vector<ReadingGrade>& grades,
                                       const std::string& site);

}  // namespace a351::corrector
