#include "corrector/command/calibration_origin.hpp"

#include <algorithm>

#include "protocol/core/input_error.hpp"
#include "protocol/text/input_file.hpp"

namespace a351::corrector {

void list_data(Calibration& calibration, const CalibrationData& data) {
    if (std::ranges::find(calibration.data, data) == calibration.data.end())
        calibration.data.push_back(data);
}

std::vector<std::string> note_origin(Calibration& calibration, const std::string& serial_number,
                                     UtcTime start, const std::vector<text::InputFile>& inputs,
                                     const std::string& file) {
    if (serial_number.empty())
        throw InputError(file +
                         ": the station metadata have no serial number of the sensor; "
                         "allowed: a record of a known unit");
    std::string& unit = calibration.serial_number;
    if (!unit.empty() && unit != serial_number)
        throw InputError(file + ": from unit " + serial_number +
                         ", the inputs before it are from " + unit + "; allowed: one unit");
    unit = serial_number;
    calibration.valid_from =
        calibration.data.empty() ? start : std::min(calibration.valid_from, start);
    std::vector<std::string> sha256;
    for (const text::InputFile& input : inputs) {
        sha256.push_back(text::sha256_of_file(input.path));
        list_data(calibration, {input.name, sha256.back()});
    }
    return sha256;
}

}  // namespace a351::corrector
