#pragma once

#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// "SITE (OCCUPATION)", with a letter for each of several set-ups: "SITE (2b)".
[[nodiscard]] std::string reading_name(const std::vector<CorrectedRow>& rows, std::size_t index);

}  // namespace a351::corrector
