#pragma once

#include <string>
#include <vector>

#include "corrector/reading/finding.hpp"
#include "protocol/events/event_log.hpp"

namespace a351::corrector::reading {

/// Returns one finding for each start-up test of this sensor that was not passed and whose result
/// applied in this time, in order of time (protocol/events/event-format.md).
/// @param serial_number  of the sensor; empty: not known, and all tests count.
/// @param events  in any order; those before `from` count too, because a result applies until the next.
[[nodiscard]] std::vector<Finding> start_up_findings(std::vector<events::Event> events,
                                                     const std::string& serial_number, UtcTime from,
                                                     UtcTime to);

}  // namespace a351::corrector::reading
