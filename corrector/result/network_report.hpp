#pragma once
/// @file
/// Results of a network adjustment.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Returns the network's size, degrees of freedom and global test as text; empty for another model.
[[nodiscard]] std::string network_text(const SurveyCorrection& result);

/// Returns the same with the redundancy of each row as JSON; null for another model.
[[nodiscard]] nlohmann::ordered_json network_json(const SurveyCorrection& result);

}  // namespace a351::corrector
