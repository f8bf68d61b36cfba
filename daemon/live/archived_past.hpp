#pragma once

#include <filesystem>

#include "daemon/live/live_record.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::daemon {

/// Gives `record` the 24 h before `now` (at more than 50 Hz as many samples) as the archive holds
/// them, so that after a restart history,
/// verdict and running occupation are where they were.  Damage is passed over.
/// @throws std::system_error  a file cannot be read; what came before it was taken.
void take_archived_past(const std::filesystem::path& archive, const record::StationCodes& codes,
                        UtcTime now, LiveRecord& record);

}  // namespace a351::daemon
