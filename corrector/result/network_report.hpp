#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// The network's degrees of freedom, global test and redundancies; empty for another model.
[[nodiscard]] std::string network_text(const SurveyCorrection& result);

/// The same; null for another model.
[[nodiscard]] nlohmann::ordered_json network_json(const SurveyCorrection& result);

}  // namespace a351::corrector
