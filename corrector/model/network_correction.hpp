#pragma once

#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Fills rows, stations, coefficients, scores and remarks of a survey from the network's adjustment.
///
/// A row's residual is against the reference, held or not; its leverage is 1 - redundancy.  Values
/// of stations in the network are the adjusted ones, with the a-priori uncertainty; a station that
/// is seen in flagged rows only has the mean of what they read.  The score's LOSO predicts every
/// datum with its own reference hidden; it needs two of them.
///
/// Rows of a loop that has no reading in the network cannot be corrected: they go from rows to
/// left_out, with a remark.
///
/// @param result       rows, options and the other models' scores are set.
/// @param not_flagged  one per row: in the network.
/// @throws InputError  the network leaves something open; says what, why and what would help.
void correct_network(SurveyCorrection& result, const std::vector<SurveyRow>& rows,
                     const std::vector<bool>& not_flagged);

}  // namespace a351::corrector
