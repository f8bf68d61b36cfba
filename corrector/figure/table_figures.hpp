#pragma once
/// @file
/// Figures that need only the rows of a survey: figures 12, 13 and 14 of the publication, and the
/// residuals in time.

#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Returns the figure of acceleration over reference, with line and R2.  Rows without a reference
/// are not in it.
/// @return std::nullopt if no row has a reference; so do the next two.
[[nodiscard]] std::optional<Figure> acceleration_figure(const SurveyCorrection& result);

/// Returns the figure of difference over temperature, with line and R2.
[[nodiscard]] std::optional<Figure> difference_figure(const SurveyCorrection& result);

/// Returns the figure of corrected value over reference, with the line y = x.
[[nodiscard]] std::optional<Figure> corrected_figure(const SurveyCorrection& result);

/// Returns the figure of residual over time, with the standard uncertainty of a new station.
[[nodiscard]] std::optional<Figure> residual_figure(const SurveyCorrection& result);

}  // namespace a351::corrector
