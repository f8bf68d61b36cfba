#pragma once

#include <vector>

namespace a351::corrector {

/// Second-order Butterworth band pass between two periods, run forward and backward: no phase, gain
/// 1 in the band and 1/2 at both periods.  The ends are continued by point reflection over three of
/// the longer periods before filtering.
///
/// Source: T. W. Parks and C. S. Burrus, Digital Filter Design, Wiley 1987, chap. 7: analogue
/// prototype, band-pass transformation, bilinear transformation with prewarped corners.
[[nodiscard]] std::vector<double> band_pass(const std::vector<double>& values, double step_s,
                                            double shorter_period_s, double longer_period_s);

}  // namespace a351::corrector
