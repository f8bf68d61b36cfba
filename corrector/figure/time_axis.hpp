#pragma once

#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Script lines for data whose first column is an instant in RFC 3339: UTC below, the
/// stays above the instants of their first readings.
[[nodiscard]] std::string time_axis(const std::vector<CorrectedRow>& rows);

}  // namespace a351::corrector
