#pragma once
/// @file
/// Figures of a record to which a calibration was applied.

#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/long_record/record_result.hpp"

namespace a351::corrector {

/// Returns the figures of a record before and after a calibration was applied: the series, and
/// their Allan deviations.
/// @pre result.applied
[[nodiscard]] std::vector<Figure> applied_figures(const RecordResult& result);

}  // namespace a351::corrector
