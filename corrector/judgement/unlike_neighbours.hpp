#pragma once
/// @file
/// Measured gravities that do not fit the height of their station.

#include <vector>

#include "corrector/model/corrected_survey.hpp"
#include "corrector/reading/finding.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::judgement {

/// Code of these findings.  They are no mistakes that the fit could feel.
inline constexpr const char* kUnlikeNeighboursCode = "unlike_neighbours";

/// Returns a finding of the kind other_name for each unknown station whose gravity, without that of
/// the normal Earth and of a plate of rock of 2670 kg/m3 up to its height, is more than 40 mGal
/// from the median of its neighbours: a stay with a wrong name, or a wrong height.  The limit is
/// 0.05 mGal for each metre above or below the neighbours, if that is more.
///
/// Neighbours are stations within 20 km; four or more are needed.  If exactly one site of the list
/// that was not visited fits within 20 mGal, its name is proposed.  In a mine, where the plate is
/// above, a true value can be named.
///
/// Reason for 40 mGal: of 29 stations in plains and mountains of North China (tests/golden/igp) the
/// farthest is off by 23 mGal, of 14 of the publication the summit, by 24.  100 m of height are 20
/// mGal.  Reason for 0.05 mGal/m: a cone of rock 3000 m high, 15 km in radius, leaves 52 mGal at
/// its summit.
/// @param sites  with the positions of the stations; those without height are not compared.
[[nodiscard]] std::vector<reading::Finding> unlike_neighbours(const model::SurveyCorrection& result,
                                                              const std::vector<text::Site>& sites);

}  // namespace a351::corrector::judgement
