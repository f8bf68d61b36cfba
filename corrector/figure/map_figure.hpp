#pragma once
/// @file
/// The map of a survey.

#include <optional>
#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/model/survey_correction.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector {

/// Returns a map of the stations in longitude and latitude with their heights.  The scale is the
/// same in both directions (by the cosine of the mean latitude) and is shown by a bar of a round
/// length.
/// @return std::nullopt if no station of the survey has a position in `sites`.
[[nodiscard]] std::optional<Figure> map_figure(const SurveyCorrection& result,
                                               const std::vector<text::Site>& sites);

}  // namespace a351::corrector
