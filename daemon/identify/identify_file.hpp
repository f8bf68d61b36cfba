#pragma once

#include <filesystem>
#include <string>

#include "daemon/identify/observation.hpp"
#include "daemon/identify/report.hpp"

namespace a351::daemon::identify {

/// Returns the name of the files about a sensor, without ending: `identify-SERIAL-TIME`.
/// Characters of the serial number that are no letters or digits become `_`.
[[nodiscard]] std::string file_stem(const Observation& seen);

/// Returns the content of the file that is to be sent: report, registers, and bytes with their
/// arrivals in seconds after the first.
[[nodiscard]] std::string file_text(const Observation& seen, const Report& report);

}  // namespace a351::daemon::identify
