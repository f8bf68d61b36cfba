#pragma once
/// @file
/// The network adjustment as a model of a survey.

#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Fills rows, stations, coefficients, scores and remarks of a survey from the adjusted network.
///
/// - A row's residual is reference - corrected, held or not.  Its leverage is 1 - redundancy;
///   outside the network it is the variance of its corrections divided by reading_sd^2.
/// - A row's u_corrected is sqrt(reading_sd^2 + variance of its corrections), a priori.
/// - Stations in the network have their adjusted value with the uncertainty a priori.  A station
///   that occurs in flagged rows only has the mean of their corrected values.
/// - LOSO predicts every datum with its own reference hidden, v / r of its row; it needs two datum
///   stations.  It agrees with hiding each reference in turn within 1e-5 of its value
///   (network_test.cpp).
/// - Rows of a loop without a reading in the network cannot be corrected: they are moved from rows
///   to left_out, with a remark.
///
/// @param result       survey with rows, options and the other models' scores.
/// @param rows         (n) in ascending time.
/// @param not_flagged  (n), true for rows in the network.
/// @throws InputError  if adjust_network() refuses; says what is undetermined, why, and what helps.
void correct_network(SurveyCorrection& result, const std::vector<SurveyRow>& rows,
                     const std::vector<bool>& not_flagged);

}  // namespace a351::corrector
