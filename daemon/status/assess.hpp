#pragma once

#include <string>

#include "daemon/source/oven_link.hpp"
#include "daemon/source/sensor_link.hpp"
#include "daemon/status/status.hpp"

namespace a351::daemon {

/// Adds a reason and raises the level to at least `level`.
void complain(Status& status, Status::Level level, std::string reason);

/// Fills in what the link knows.
void fill(Status& status, const LinkStatus& link);

/// Fills in what the oven's link knows: the oven is part of the status then.
void fill(Status& status, const OvenLinkStatus& link);

/// Completes level and reasons of a status that is filled in: no data, no time, no space, no
/// oven.
void assess(Status& status);

}  // namespace a351::daemon
