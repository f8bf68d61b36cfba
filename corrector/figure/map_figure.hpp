#pragma once

#include <optional>
#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/model/survey_correction.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector {

/// Stations by longitude and latitude with their heights, one scale both ways (cosine of the mean
/// latitude), with a bar of a round length.
/// @return std::nullopt when no station of the survey has a place in `sites`.
[[nodiscard]] std::optional<Figure> map_figure(const SurveyCorrection& result,
                                               const std::vector<text::Site>& sites);

}  // namespace a351::corrector
