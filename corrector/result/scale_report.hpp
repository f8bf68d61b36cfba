#pragma once
/// @file
/// Scale factors of the instruments of a survey, in sentences and as JSON.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "corrector/model/corrected_survey.hpp"

namespace a351::corrector::result {

/// Returns one sentence for each instrument: value, limits, share of the prior, and what it means for
/// a difference of gravity.  None for a model without this term.
[[nodiscard]] std::vector<std::string> scale_sentences(const model::SurveyCorrection& result);

/// Returns an array of the scales with these keys: instrument (null for the sensor), value, u,
/// limits_95, prior (mean, sd), prior_share.
[[nodiscard]] nlohmann::ordered_json scales_json(const std::vector<model::ScaleEstimate>& scales);

}  // namespace a351::corrector::result
