#pragma once

#include <string>
#include <vector>

#include "protocol/text/input_file.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector {

/// Adds a file to the list unless it is there already.
void list_data(Calibration& calibration, const CalibrationData& data);

/// Notes where numbers of a calibration come from: unit, files, the time of the first reading.
/// @param serial_number  of the record; empty if the metadata have none.
/// @return  SHA-256 of every file of the archive.
/// @throws InputError  no serial number, or not the one of the inputs before.
std::vector<std::string> note_origin(Calibration& calibration, const std::string& serial_number,
                                     UtcTime start, const std::vector<text::InputFile>& inputs,
                                     const std::string& file);

}  // namespace a351::corrector
