#pragma once

#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/long_record/record_result.hpp"

namespace a351::corrector {

/// Before and after a calibration was applied: the series, and their Allan deviations.
/// @pre result.applied
[[nodiscard]] std::vector<Figure> applied_figures(const RecordResult& result);

}  // namespace a351::corrector
