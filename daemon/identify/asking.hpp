#pragma once

#include "daemon/identify/observation.hpp"
#include "daemon/source/host_clock.hpp"
#include "daemon/source/sensor_link.hpp"

namespace a351::daemon::identify {

/// Asks the sensor for everything that it can say, in less than a minute:
///
/// - listens for 1.2 s.  To text it sends nothing: that is another instrument.
/// - handshake, which also reads all registers; if nothing answers, at the other baud rates.
/// - receives frames for 50 s of instrument time, then stops the sampling.
///
/// Nothing is recorded, and the flash of the sensor is not written.
/// @param link  its address, baud, profile, settings and `open` are used.
/// @throws source::PortError  the port cannot be opened.
[[nodiscard]] Observation ask_sensor(const source::LinkOptions& link,
                                     const source::HostClock& clock);

}  // namespace a351::daemon::identify
