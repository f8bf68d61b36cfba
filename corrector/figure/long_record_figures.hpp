#pragma once
/// @file
/// Figures of a long record at one point: figures 2 to 7 of the publication, the response by period,
/// and the effect of a calibration.

#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/long_record/record_result.hpp"

namespace a351::corrector {

/// Returns the figures in the publication's order.  Of a long series the least and the greatest
/// value of each of 1500 steps are drawn, of a long scatter at most kMostPoints points at equal
/// distances.
[[nodiscard]] std::vector<Figure> long_record_figures(const RecordResult& result);

/// Returns the figure of gain and phase by period, from spectra and from modes, with the two-path
/// fit.
[[nodiscard]] Figure response_figure(const RecordResult& result);

/// Returns the figures of a record before and after a calibration was applied: the series, and
/// their Allan deviations.
/// @pre result.applied
[[nodiscard]] std::vector<Figure> applied_figures(const RecordResult& result);

}  // namespace a351::corrector
