#pragma once

#include <filesystem>

#include "daemon/live/live_record.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::daemon {

/// Loads the 24 h before `now` from the archive into `record` (above 50 Hz the same number of
/// samples), so that history, verdict and running occupation are the same after a restart.  Damaged
/// data are skipped.
/// @throws std::system_error  a file cannot be read; data before it were loaded.
void take_archived_past(const std::filesystem::path& archive, const record::StationCodes& codes,
                        UtcTime now, LiveRecord& record);

}  // namespace a351::daemon
