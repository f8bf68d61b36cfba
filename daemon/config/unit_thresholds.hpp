#pragma once

#include "daemon/verdict/verdict_options.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::daemon {

/// The defaults of [verdict] for a unit that was measured: its response to temperature instead of
/// the published one's, and a warm-up that decays to the calibration's limit at its hour.
[[nodiscard]] VerdictOptions thresholds_for(const corrector::Calibration& unit);

}  // namespace a351::daemon
