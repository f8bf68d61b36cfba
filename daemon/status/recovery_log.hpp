#pragma once

#include "protocol/archive/recovery.hpp"

namespace spdlog {
class logger;
}

namespace a351::daemon::status {

/// Logs the result of the recovery at the start: what was damaged, cut, added, lost or kept.
void log_recovery(spdlog::logger& log, const archive::RecoveryReport& report);

}  // namespace a351::daemon::status
