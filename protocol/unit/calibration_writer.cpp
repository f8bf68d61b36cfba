#include <fmt/core.h>

#include "protocol/text/csv.hpp"
#include "protocol/text/strict_toml.hpp"
#include "protocol/unit/calibration.hpp"

namespace a351::unit {
namespace {

std::string time_line(std::string_view key, UtcTime time) {
    constexpr int kNanosecondDecimals = 9;
    return fmt::format("{} = \"{}\"\n", key, to_rfc3339(time, kNanosecondDecimals));
}

std::string number_line(std::string_view key, double value) {
    return fmt::format("{} = {}\n", key, text::shortest(value));
}

template <typename Names, int kCount>
std::string table(std::string_view name, const Names& names,
                  const CalibratedCoefficients<kCount>& part) {
    std::string list, values, covariance;
    for (Eigen::Index i = 0; i < kCount; ++i) {
        const std::string comma = i == 0 ? "" : ", ";
        list += fmt::format("{}\"{}\"", comma, names.at(static_cast<std::size_t>(i)));
        values += comma + text::shortest(part.values(i));
        covariance += "\n ";
        for (Eigen::Index j = 0; j < kCount; ++j)
            covariance += ' ' + text::shortest(part.covariance(i, j)) + ',';
    }
    return fmt::format("\n[{}]\ncoefficients = [{}]\nvalues = [{}]\ncovariance = [{}\n]\n", name,
                       list, values, covariance);
}

}  // namespace

std::string to_toml(const Calibration& calibration) {
    std::string text =
        "# Calibration of one unit; format: calibration-format.md of a351.\nformat = 1\n";
    text += "serial_number = " + text::toml_string(calibration.serial_number) + '\n';
    text += "program = " + text::toml_string(calibration.program) + '\n';
    text += time_line("valid_from_utc", calibration.valid_from);
    if (calibration.valid_to) text += time_line("valid_to_utc", *calibration.valid_to);
    if (calibration.axis_bias) text += table("axis_bias", kAxisBiasNames, *calibration.axis_bias);
    if (calibration.thermal) text += table("thermal", kThermalNames, *calibration.thermal);
    if (calibration.warm_up) {
        text += "\n[warm_up]\n" + number_line("within_mgal", calibration.warm_up->within_mgal) +
                number_line("after_power_on_h", calibration.warm_up->after_power_on_h);
    }
    if (calibration.placement) {
        const Placement& placement = *calibration.placement;
        text += "\n[placement]\n" + number_line("standard_deviation_mgal", placement.mgal) +
                fmt::format("limits_mgal = [{}, {}]\n", text::shortest(placement.low_mgal),
                            text::shortest(placement.high_mgal));
    }
    if (calibration.scale)
        text += "\n[scale]\n" + number_line("value", calibration.scale->value) +
                number_line("standard_error", calibration.scale->standard_error);
    if (calibration.faces) text += table("faces", kFacesNames, *calibration.faces);
    for (const CalibrationData& data : calibration.data)
        text += fmt::format("\n[[data]]\nname = {}\nsha256 = {}\n", text::toml_string(data.name),
                            text::toml_string(data.sha256));
    return text;
}

}  // namespace a351::unit
