#include "sim/oven/oven_variables.hpp"

#include <algorithm>
#include <array>

namespace a351::sim::oven {
namespace {

using enum Variable;
using enum WriteLevel;

constexpr std::array kEntries = {
    VariableEntry{process_value, none, 0x0000, 0x2000},
    VariableEntry{status, none, 0x0002, 0x2001},
    VariableEntry{internal_set_point, none, 0x0004, 0x2002},
    VariableEntry{heater_current, none, 0x0006, 0x2003},
    VariableEntry{drive_heating, none, 0x0008, 0x2004},
    VariableEntry{drive_cooling, none, 0x000A, 0x2005},
    VariableEntry{set_point, operation, 0x0106, 0x2103},
    VariableEntry{alarm_1, operation, 0x0108, 0x2104},
    VariableEntry{alarm_1_upper, operation, 0x010A, 0x2105},
    VariableEntry{alarm_1_lower, operation, 0x010C, 0x2106},
    VariableEntry{process_value, none, 0x0404, 0x2402},
    VariableEntry{internal_set_point, none, 0x0406, 0x2403},
    VariableEntry{status, none, 0x040C, 0x2406},
    VariableEntry{status_high, none, std::nullopt, 0x2407},
    VariableEntry{status_2, none, 0x0410, 0x2408},
    VariableEntry{status_2_high, none, std::nullopt, 0x2409},
    VariableEntry{decimal_point, none, 0x0420, 0x2410},
    VariableEntry{input_filter, operation, 0x0800, 0x2800},
    VariableEntry{set_point, operation, 0x0900, 0x2900},  // Set point 0, the only one emulated.
    VariableEntry{proportional_band, operation, 0x0A00, 0x2A00},
    VariableEntry{integral_time, operation, 0x0A02, 0x2A01},
    VariableEntry{derivative_time, operation, 0x0A04, 0x2A02},
    VariableEntry{input_type, setup, 0x0C00, 0x2C00},
    VariableEntry{control_kind, setup, 0x0D28, 0x2D14},
};

}  // namespace

const VariableEntry* find_variable(std::uint16_t address) noexcept {
    const auto found = std::find_if(kEntries.begin(), kEntries.end(), [&](const auto& entry) {
        return entry.two_byte == address || entry.four_byte == address;
    });
    return found == kEntries.end() ? nullptr : &*found;
}

}  // namespace a351::sim::oven
