#pragma once

#include <string>

#include "daemon/ctl/client.hpp"

namespace a351::daemon::ctl {

/// Shows the status every second until the operator quits.
///
/// On a terminal it is one screen, with keys for the changes of the running stay.  Otherwise the
/// screens of `status` follow each other.
/// @param token          empty: the daemon is asked for it.
/// @param operator_name  for the event log; may be empty.
void watch(const Client& client, const std::string& token, const std::string& operator_name);

}  // namespace a351::daemon::ctl
