#pragma once
/// @file
/// The settings that are stored with the recorded data.

#include "daemon/config/config.hpp"
#include "daemon/source/host_clock.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/station/station_xml.hpp"

namespace a351::daemon {

/// Makes the header of the journal; session and device are filled in by the sensor's link.
[[nodiscard]] record::JournalHeader journal_header(const Config& config, const HostClock& clock);

/// Describes the station; device and times are added for each session.
[[nodiscard]] record::StationDescription station_description(const Config& config);

}  // namespace a351::daemon
