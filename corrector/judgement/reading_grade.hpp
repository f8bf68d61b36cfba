#pragma once
/// @file
/// Grades of readings: which ones to trust, and which ones to repeat.
///
/// A grade advises the operator, who can still repeat a reading.  It changes no result and leaves
/// no row out of the fit.
///
///     const std::vector<ReadingGrade> grades = grade_readings(result);
///     for (std::size_t i = 0; i < grades.size(); ++i)
///         if (grades[i].grade == Grade::repeat)
///             show(reading_name(result.rows, i), grades[i].reasons);

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::judgement {

/// Advice on a reading, from the best to the worst.  The grade of a reading is the worst that any
/// of its reasons gives.
/// - `trust`: use it.
/// - `care`: use it after a look at the reasons and at the record.
/// - `repeat`: read the station again, first if it has no other reading to trust.
enum class Grade {
    trust,   ///< Nothing about it is unusual.
    care,    ///< Usable, but something is unusual.
    repeat,  ///< Not reliable.
};

/// A reason for a grade.
struct Reason {
    std::string code;             ///< Which sentence the text is.
    std::vector<double> numbers;  ///< Numbers of the sentence, unrounded, in its order.
    text::Message text;           ///< The reason in words, without the reading's name.
};

/// Code of a reason that all readings of a survey have.
inline constexpr const char* kOfWholeSurvey = "whole_survey";

/// Limits of |error| / u above which a value gets `care` and `repeat`.  Reason: one in 22 Gaussian
/// errors is above the first, one in 370 above the second.
inline constexpr double kCareRatio = 2.0, kRepeatRatio = 3.0;

/// Returns the grade's name in tables, which is that in the enumeration.
/// @param grade  one of the enumerators; another value is not checked.
[[nodiscard]] std::string_view grade_name(Grade grade) noexcept;

/// The grade of one reading.  `trust` has no reasons.
struct ReadingGrade {
    Grade grade = Grade::trust;
    std::vector<Reason> reasons;
};

/// Returns the reasons as one text, joined by "; ": in English, and in the language of the program.
[[nodiscard]] std::string reason_text(const ReadingGrade& reading);
[[nodiscard]] std::string reason_in_words(const ReadingGrade& reading);

/// Returns the error to which u_corrected belongs, mGal: corrected - reference, or for `day`
/// left_out - reference.  Absent without a reference, and for `day` if only this station is held.
[[nodiscard]] std::optional<double> error_of(const model::CorrectedRow& row);

/// Returns true for a network that fails the global test on its upper side.
[[nodiscard]] bool scatters_more_than_stated(const model::SurveyCorrection& result);

/// Returns one grade per row.
///
/// A reason is only what makes readings worse on simulated days (remarks_bench.py); the figures and
/// all rules are in corrector/methods.md, "Report".
///
/// - Not used by the operator or an amendment, or never at rest: `repeat`.
/// - Temperature that was not steady (temperature_doubt()), not for `day`: `care` if the model has a
///   term for its rate, else `repeat`.  A knock that split the record, not for `day`: `care`.
/// - Residual, if no mistake is named: `care` above 2 u_corrected, `repeat` above 3.  A row without
///   residual or u is not tested.  For `day` it is the error of the prediction without the row's station.
/// - Mistakes found at the stay: `repeat` for a bad reading, else `care`.
/// - Samples: `care` if their standard error is above u_corrected, `repeat` if the effect of shaking
///   is.
/// - Two readings of a station, if no mistake is named: both get `care` if they differ by more than 2
///   sqrt(2) s (`day`: placement).  Of more than two the pair that differs most, with a limit that as
///   few stations exceed by chance.  Readings that have `repeat` for another reason are not compared.
/// - A day that is not usable, or a network that fails the global test with more than twice the
///   scatter stated: all `care`.
///
/// A value exactly at its limit is trusted (reading_grade_test.cpp).
/// @param result  rows in ascending time, with coefficients, score and stations.
/// @return (n) in the order of the rows; an empty list without rows.
[[nodiscard]] std::vector<ReadingGrade> grade_readings(const model::SurveyCorrection& result);

/// Returns the grade of a station, which is the best of its readings.
///
/// `trust` has no reasons here.  Otherwise they are those of its readings with this grade; the first
/// of a reading begins with its name (reading_name.hpp).
/// @param grades  from grade_readings() of this result.
/// @param site    has at least one row.
[[nodiscard]] ReadingGrade grade_of_station(const model::SurveyCorrection& result,
                                            const std::vector<ReadingGrade>& grades,
                                            const std::string& site);

}  // namespace a351::corrector::judgement
