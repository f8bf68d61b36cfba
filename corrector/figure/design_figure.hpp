#pragma once
/// @file
/// Figure of a planned survey.

#include "corrector/design/expected_errors.hpp"
#include "corrector/figure/figure.hpp"

namespace a351::corrector::figure {

/// Returns the figure of the expected variance of each unknown station, as a bar with the parts of
/// its sources; the label is the standard uncertainty.
[[nodiscard]] Figure design_figure(const design::ExpectedErrors& errors, const Print& print);

}  // namespace a351::corrector::figure
