#pragma once

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::sim::signal {

/// Returns the effect of Sun and Moon on gravity, positive where gravity is larger, by Longman's
/// closed formulas.  The simulator has its own tide so that the corrector is tested against
/// independent code.
///
/// @param factor  gravimetric factor 1 + h2 - 3/2 k2: 1 for the rigid Earth; 1.1575 with Longman's
///                h2 = 0.612 and k2 = 0.303; gravimetry commonly uses 1.16.
/// Accuracy: 0.003 mGal against tide catalogues (rigid Earth, twentieth and twenty-first century).
/// Source: I. M. Longman, Formulas for computing the tidal accelerations due to the Moon and the
/// Sun, J. Geophys. Res. 64(12), 2351-2355, 1959, doi:10.1029/JZ064i012p02351.  There upward is
/// positive: the sign is opposite.
[[nodiscard]] MilliGal earth_tide(Degrees latitude, Degrees longitude, Metres height, UtcTime time,
                                  double factor);

}  // namespace a351::sim::signal
