#include "protocol/unit/calibration_origin.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "protocol/core/input_error.hpp"
#include "protocol/text/input_file.hpp"

namespace a351::unit {

void list_data(Calibration& calibration, const CalibrationData& data) {
    if (std::ranges::find(calibration.data, data) == calibration.data.end())
        calibration.data.push_back(data);
}

std::vector<std::string> note_origin(Calibration& calibration, const std::string& serial_number,
                                     UtcTime start, const std::vector<text::InputFile>& inputs,
                                     const std::string& file) {
    if (serial_number.empty())
        throw InputError(file +
                         ": the station metadata have no serial number of the sensor; allowed: a "
                         "record of a known unit");
    std::string& unit = calibration.serial_number;
    if (!unit.empty() && unit != serial_number)
        throw InputError(
            fmt::format("{}: from unit {}, the inputs before it are from {}; allowed: one unit",
                        file, serial_number, unit));
    unit = serial_number;
    calibration.valid_from =
        calibration.data.empty() ? start : std::min(calibration.valid_from, start);
    std::vector<std::string> of_archive;
    for (const text::InputFile& input : inputs) {
        const std::string sha256 = text::sha256_of_file(input.path);
        list_data(calibration, {input.name, sha256});
        if (input.role == "archive") of_archive.push_back(sha256);
    }
    return of_archive;
}

}  // namespace a351::unit
