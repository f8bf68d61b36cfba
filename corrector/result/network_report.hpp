#pragma once
/// @file
/// Results of a network adjustment: size, global test, and the comparison with known stations that
/// the network does not hold.
///
/// That comparison is independent of the adjustment, so it is marked "not in sample".  It includes
/// stations with a reference that are not among the datum and have an unflagged row.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "corrector/model/corrected_survey.hpp"

namespace a351::corrector::result {

/// Returns the network's size, degrees of freedom, global test, kind of uncertainty and comparison
/// with known stations as text; empty for another model.
///
/// Each line ends with LF.  Without a degree of freedom there is no line on the test, and without a
/// station to compare with none on the comparison.  If the test fails, the text has the
/// reading_sd_mgal that agrees with the scatter.  Do not use it at once: a failed test usually
/// means a fault in a reading.
[[nodiscard]] std::string network_text(const model::SurveyCorrection& result);

/// Returns the same with the redundancy of each row as JSON; null for another model.
///
/// - Keys: datum_sd_mgal, drift_degree, unknowns, dof, weighted_square, global_test (alpha, low,
///   high, passed), s0, u_gravity, references_not_held (stations, rms_mgal), rows (row, residual,
///   sd, redundancy).
/// - weighted_square is v'Wv, compared with the chi-square limits low and high
///   (corrector/methods.md).
/// - `passed` and `s0` are null without a degree of freedom, rms_mgal without a station.
/// - Residual and sd have the unit of their row: mGal for readings and datum, that of the
///   coefficient for priors.
[[nodiscard]] nlohmann::ordered_json network_json(const model::SurveyCorrection& result);

}  // namespace a351::corrector::result
