#pragma once

#include <string>

#include "daemon/source/oven_link.hpp"
#include "daemon/source/sensor_link.hpp"
#include "daemon/status/status.hpp"

namespace a351::daemon {

/// Adds a reason and raises the level to at least `level`.
void complain(Status& status, Status::Level level, std::string reason);

/// Copies the state of the sensor's link into the status, and adds its reasons.
void fill(Status& status, const LinkStatus& link);

/// Copies the state of the oven's link into the status.  The status then includes the oven.
void fill(Status& status, const OvenLinkStatus& link);

/// Adds the level and reasons of a completely filled status: sample rate, oven, calibration, sample
/// times and disk space.
void assess(Status& status);

}  // namespace a351::daemon
