#pragma once
/// @file
/// Comparison of the two trends of the occupations' records.
///
/// Every record is averaged with two trends, the decomposition (EEMD) and the smoother; one of them
/// gives the reading.  Their difference shows how much the reading depends on this choice:
///
///     trends, smoother minus EEMD: mean -0.050, rms 0.354, largest -0.400 mGal at No.5 (2)

#include <string>

#include "corrector/model/corrected_survey.hpp"

namespace a351::corrector::model {

/// Returns one line with mean, rms and largest value of the difference between the two trends of
/// the occupations' records (occupations.csv, smoother_minus_eemd_mgal); empty without rows from
/// records.
///
/// Every row with a record counts, also flagged rows.  The largest value is that of the largest
/// magnitude; the number in brackets is that of the stay.  The line ends with a newline.
/// @param result  a corrected survey; the corrections have no effect here.
[[nodiscard]] std::string trend_comparison_text(const SurveyCorrection& result);

}  // namespace a351::corrector::model
