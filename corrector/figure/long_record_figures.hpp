#pragma once
/// @file
/// Figures of a long record at one point: 2 to 7 of the publication, and its response by period.

#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/long_record/record_result.hpp"

namespace a351::corrector {

/// In the publication's order; a series of more than some thousand points is drawn by the least and
/// greatest of each step, a scatter by every so-manieth point.
[[nodiscard]] std::vector<Figure> long_record_figures(const RecordResult& result);

/// Gain and phase by period in both ways, with the two-path fit.
[[nodiscard]] Figure response_figure(const RecordResult& result);

}  // namespace a351::corrector
