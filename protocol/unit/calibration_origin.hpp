#pragma once
/// @file
/// Origin of the numbers of a calibration, so that a user can check it later: unit, files with
/// their SHA-256, start of validity.
///
/// A survey of another unit is refused by the serial number.  The checksums show whether a record
/// is one of those that the calibration was measured from.

#include <string>
#include <vector>

#include "protocol/text/input_file.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::unit {

/// Adds a file to the list unless it is there already.  Name and checksum are compared, so a
/// changed file of the same name is listed twice.
void list_data(Calibration& calibration, const CalibrationData& data);

/// Notes where numbers of a calibration come from: unit, files, the time of the first reading.
///
/// Call it once per input.  `valid_from` becomes the earliest start of all inputs.  Each file is
/// read once more for its SHA-256.
/// @param serial_number  of the record; empty if the metadata have none.
/// @param start          time of the first reading of this input.
/// @param inputs         files that were read, with their paths; all are listed in `data`.
/// @param file           name of the input as the user gave it, for messages.
/// @return  SHA-256 of every file of the archive.
/// @throws InputError  no serial number, or not the one of the inputs before.
std::vector<std::string> note_origin(Calibration& calibration, const std::string& serial_number,
                                     UtcTime start, const std::vector<text::InputFile>& inputs,
                                     const std::string& file);

}  // namespace a351::unit
