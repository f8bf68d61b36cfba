#pragma once

#include "protocol/journal/journal.hpp"
#include "protocol/station/station_xml.hpp"

namespace a351::station {

/// Adds to the description of a station what a header of the journal has: codes, sensor, settings, and
/// the start by the clock of the host.  Position, and which ovens there are, remain.
/// @throws std::invalid_argument  the header's profile is unknown.
void describe_session(Description& description, const journal::Header& header);

}  // namespace a351::station
