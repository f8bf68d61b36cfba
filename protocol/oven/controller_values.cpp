#include "protocol/oven/controller_values.hpp"

#include <cmath>

namespace a351::oven {
namespace {

/// Divides instead of multiplying by 0.1, which gives the double nearest to the displayed value.
double scaled(std::uint16_t digits, int decimals) {
    return static_cast<std::int16_t>(digits) / std::pow(10.0, decimals);
}

}  // namespace

bool has_input_error(std::uint16_t status) noexcept {
    return (status & (kInputError | kAdConverterError | kDisplayRangeExceeded)) != 0;
}

std::optional<ControllerValues> controller_values(std::span<const std::uint16_t> registers,
                                                  int decimals) {
    if (registers.size() != kMonitorCount) return std::nullopt;
    const auto value = [&](Monitor monitor) {
        return registers[static_cast<std::size_t>(monitor)];
    };
    ControllerValues values;
    values.status = value(Monitor::status);
    if (!has_input_error(values.status))
        values.process_value = DegC(scaled(value(Monitor::process_value), decimals));
    values.set_point = DegC(scaled(value(Monitor::set_point), decimals));
    values.heating = Percent(scaled(value(Monitor::heating), 1));
    return values;
}

}  // namespace a351::oven
