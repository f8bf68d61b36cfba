#pragma once
/// @file
/// The time axis of figures.

#include <string>
#include <vector>

#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Returns script lines for data whose first column is an instant in RFC 3339.  UTC is below the
/// figure; the stays are above it, at the instants of their first readings.
[[nodiscard]] std::string time_axis(const std::vector<CorrectedRow>& rows);

}  // namespace a351::corrector
