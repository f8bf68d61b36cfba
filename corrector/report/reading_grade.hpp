#pragma once
/// @file
/// Which readings of a survey to trust and which to repeat.

#include <string>
#include <vector>

#include "corrector/survey/survey_correction.hpp"

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

/// Limits of the grades.
struct GradeLimits {
    /// Faster than this the temperature was not steady: the publication's three lost readings and
    /// one more lie above it.
    double slope_degc_per_h = 0.2;
    /// The same for a temperature that only rises or only falls during a reading.
    DegC monotone_range{0.05};
    /// Of the two trends of one record: a quarter of the 2 mGal that good readings scatter by.
    MilliGal trend_difference{0.5};
    /// |residual| / u: of Gaussian errors one in 22 lies above the first, one in 370 above the
    /// other.
    double care_ratio = 2.0;
    double repeat_ratio = 3.0;
};

/// One grade per row.  A fast temperature means `repeat` when the model has no term for its rate,
/// else `care`; a reading that the operator marked means `repeat` unless it is in the fit.
[[nodiscard]] std::vector<ReadingGrade> grade_readings(const SurveyCorrection& result,
                                                       const GradeLimits& limits = {});

/// Whether a reading of this station is graded `trust`.
[[nodiscard]] bool has_trusted_reading(const SurveyCorrection& result,
                                       const std::vector<ReadingGrade>& grades,
                                       const std::string& site);

}  // namespace a351::corrector
