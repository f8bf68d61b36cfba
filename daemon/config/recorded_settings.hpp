#pragma once
/// @file
/// What the record says of the settings it was made with.

#include "daemon/config/config.hpp"
#include "daemon/source/host_clock.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/station/station_xml.hpp"

namespace a351::daemon {

/// Session and device are filled in by the link.
[[nodiscard]] record::JournalHeader journal_header(const Config& config, const HostClock& clock);

/// Device and instants come with each session.
[[nodiscard]] record::StationDescription station_description(const Config& config);

}  // namespace a351::daemon
