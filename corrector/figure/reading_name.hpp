#pragma once
/// @file
/// Names of readings in figures and reports.

#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Returns "SITE (OCCUPATION)"; if the stay has several set-ups, with a letter: "SITE (2b)".
[[nodiscard]] std::string reading_name(const std::vector<CorrectedRow>& rows, std::size_t index);

}  // namespace a351::corrector
