#pragma once

#include <string>
#include <vector>

#include "protocol/text/input_file.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::corrector {

/// Lists every file once, however many records and calibrations have it.
void list_data(Calibration& calibration, const CalibrationData& data);

/// Notes where numbers of a calibration come from: unit, files, the time of the first reading.
/// @param serial_number  of the record; empty: the metadata do not tell.
/// @return  SHA-256 of every input.
/// @throws InputError  no serial number, or another than that of what came before.
std::vector<std::string> note_origin(Calibration& calibration, const std::string& serial_number,
                                     UtcTime start, const std::vector<text::InputFile>& inputs,
                                     const std::string& file);

}  // namespace a351::corrector
