#pragma once
/// @file
/// The first lines about a survey: how well it knows gravity, what to repeat, and one line for each
/// station.  Terminal and report begin with it.
///
///     const auto grades = judgement::grade_readings(result);
///     std::cout << answer(result, grades) << "\n\n" << aligned_text(answer_table(result, grades));
///
/// All texts are in the language of the program.

#include <optional>
#include <string>
#include <vector>

#include "corrector/judgement/reading_grade.hpp"
#include "corrector/model/corrected_survey.hpp"
#include "corrector/result/table.hpp"

namespace a351::corrector::result {

/// Returns decimals_for() of the median uncertainty of the stations, or of the standard error of a
/// coefficient (without one: 4).
[[nodiscard]] int decimals_of(const model::SurveyCorrection& result);
[[nodiscard]] int decimals_of(const model::Coefficient& coefficient);

/// Returns the first sentences: number of stations, error of a new one, what to repeat.
///
/// The error is the leave-one-station-out error; with fewer than five known stations it is the range
/// of u, unless that comes from fewer than five degrees of freedom.  Findings that are no remarks
/// must be looked at first; if one proposes an amendment or the day is not usable, nothing is said
/// to repeat.
/// @param grades  from grade_readings() of this result.
[[nodiscard]] std::string answer(const model::SurveyCorrection& result,
                                 const std::vector<judgement::ReadingGrade>& grades);

/// Returns a line per station: readings, gravity, u, difference from the reference, mark.
///
/// The difference is that of the value with the reference left out; for a model that gives no such
/// value it is that of gravity, which is in sample.  The mark is the grade of the station.
[[nodiscard]] Table answer_table(const model::SurveyCorrection& result,
                                 const std::vector<judgement::ReadingGrade>& grades);

/// Returns what must be known beside the table: occupations without a value, each reading that is
/// not to be trusted with its reasons (unless a finding says them), stations that nothing checks.
[[nodiscard]] std::vector<std::string> notes(const model::SurveyCorrection& result,
                                             const std::vector<judgement::ReadingGrade>& grades);

}  // namespace a351::corrector::result
