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

/// Writes this file to the folder and, if the report has one, the profile beside it.
/// @return their name without ending.
/// @throws std::system_error  one cannot be written.
std::string write_files(const std::filesystem::path& folder, const Observation& seen,
                        const Report& report);

}  // namespace a351::daemon::identify
