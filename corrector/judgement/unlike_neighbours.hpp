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

/// Returns true for a mistake that the fit can feel: one that the search has found.
[[nodiscard]] inline bool is_searched_mistake(const reading::Finding& finding) {
    return reading::is_mistake(finding) && finding.code != kUnlikeNeighboursCode;
}

/// Returns a finding of the kind other_name for each unknown station whose gravity, without that of
/// the normal Earth and of a plate of rock of 2670 kg/m3 up to its height, is more than 40 mGal
/// from the median of its neighbours: a stay with a wrong name, or a wrong height.  The limit is
/// 0.05 mGal for each metre above or below the neighbours, if that is more.
///
/// Neighbours are stations within 20 km; four or more are needed.  If exactly one site of the list
/// that was not visited fits within 20 mGal, its name is proposed.  In a mine, where the plate is
/// above, a true value can be named.
///
/// Reason for 40 mGal: 100 m of height are 20 mGal, and no station of the publication or of a campaign
/// in North China is named (unlike_neighbours_test.cpp, igp_network_test.cpp).  Reason for 0.05
/// mGal/m: at the top of a cone of rock with slopes of 27 deg a plate attracts so much more.
/// @param sites  with the positions of the stations; those without height are not compared.
[[nodiscard]] std::vector<reading::Finding> unlike_neighbours(const model::SurveyCorrection& result,
                                                              const std::vector<text::Site>& sites);

}  // namespace a351::corrector::judgement
