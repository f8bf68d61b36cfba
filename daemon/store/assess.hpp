#pragma once

#include <string>

#include "daemon/page/status.hpp"
#include "daemon/source/sensor_link.hpp"

namespace a351::daemon {

/// Adds a reason and raises the level to at least `level`.
void complain(Status& status, Status::Level level, std::string reason);

/// Fills in what the link knows.
void fill(Status& status, const LinkStatus& link);

/// Completes level and reasons of a status that is filled in: no data, no time, no space.
void assess(Status& status);

}  // namespace a351::daemon
