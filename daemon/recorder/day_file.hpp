#pragma once

#include <functional>
#include <string>

#include "daemon/config/config.hpp"
#include "daemon/page/message.hpp"
#include "daemon/survey/occupations.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon::recorder {

/// Returns the survey day as one file, to be sent to a browser or to a351ctl.
/// @param gravity_so_far  JSON, see gravity::GravitySoFar::document().
/// @param failed          receives the cause if the file ends before its end; any thread.
/// @throws std::system_error  the list of sites or the calibration cannot be read.
[[nodiscard]] page::Download bundle_of_day(
    const config::Config& config, UtcTime now, const survey::Occupations& occupations,
    const std::string& gravity_so_far, const std::function<void(const std::string& cause)>& failed);

}  // namespace a351::daemon::recorder
