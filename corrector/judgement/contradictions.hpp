#pragma once
/// @file
/// Contradictions in a survey that is still being made.  The operator can still clear them up.

#include <string>
#include <vector>

#include "corrector/judgement/reading_grade.hpp"
#include "corrector/model/corrected_survey.hpp"
#include "protocol/text/message.hpp"

namespace a351::corrector::judgement {

/// Readings that do not agree.
struct Contradiction {
    std::string code;        ///< Code of the finding, or `references`, or `set_ups`.
    std::string site;        ///< Site of the stay; empty: the whole day.
    int occupation = 1;      ///< Number of the stay at the site.
    std::string key;         ///< Key of the stay; may be empty.
    text::Message text;      ///< Which, how much, and what to do.
    bool is_lesser = false;  ///< Its ratio is at most kContradictionRatio.
};

/// Least ratio of a difference to its uncertainty.  Reason: 19 readings have one above 4 by chance on
/// 1 day of 800, if their errors are normal; the signal must be LOOK on few stays without a mistake.
inline constexpr double kContradictionRatio = 4.0;

/// Ratio above which a contradiction that was shown stays.  Reason: the ratio changes a little with each
/// further sample, and above this the grade of the reading is `repeat`.
inline constexpr double kLesserRatio = kRepeatRatio;

/// Returns the contradictions of a survey so far, the newest last:
///
/// - each mistake that the search found, except a moved box: the question comes when it is moved;
/// - a known station whose value, left out, is off its reference by more than kContradictionRatio
///   times its uncertainty.  With two known stations neither can be named alone, so both are;
/// - two set-ups of a stay that differ by more than kContradictionRatio times the placement of the
///   other stays.
///
/// Those with a ratio above kLesserRatio only are lesser ones.
///
/// Errors and power: corrector/accuracy.md, "The signal".
/// @param result       with its findings.
/// @param running_key  key of the stay that runs: there the box can be set down again; empty: none.
[[nodiscard]] std::vector<Contradiction> contradictions(const model::SurveyCorrection& result,
                                                        const std::string& running_key = {});

/// Returns the factor by which the uncertainties of a survey with contradictions are too small: the
/// median of the ratios of the known stations, divided by that of a normal error; at least 1.
///
/// One station that is off among many does not change it; two that contradict each other do.
[[nodiscard]] double doubt_factor(const model::SurveyCorrection& result);

}  // namespace a351::corrector::judgement
