#pragma once
/// @file
/// Figures that need no more than the rows of a survey: 12, 13 and 14 of the publication and the
/// residuals in time.

#include <vector>

#include "corrector/figure/figure.hpp"
#include "corrector/model/survey_correction.hpp"

namespace a351::corrector {

/// Acceleration over reference, with line and R2.  Rows without a reference are not in it.
/// @return std::nullopt without such rows, as do the others that need references.
[[nodiscard]] std::optional<Figure> acceleration_figure(const SurveyCorrection& result);

/// Difference over temperature, with line and R2.
[[nodiscard]] std::optional<Figure> difference_figure(const SurveyCorrection& result);

/// Corrected value over reference, with the line y = x.
[[nodiscard]] std::optional<Figure> corrected_figure(const SurveyCorrection& result);

/// Residual over time, with its standard uncertainty as of a new station.
[[nodiscard]] std::optional<Figure> residual_figure(const SurveyCorrection& result);

}  // namespace a351::corrector
