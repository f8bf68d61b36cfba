#pragma once
/// @file
/// Meaning of the controller's registers.  No I/O.

#include <cstdint>
#include <optional>
#include <span>

#include "protocol/core/units.hpp"
#include "protocol/oven/registers.hpp"

namespace a351::oven {

/// Values of one poll of the controller.
struct ControllerValues {
    /// Absent if the status reports an input error.  No manual defines the register's value then;
    /// mostly it is an end of the range.
    std::optional<DegC> process_value;
    DegC set_point;
    Percent heating;
    std::uint16_t status = 0;
};

/// Converts the registers of one read to values.
/// @param registers  from kFirstMonitor on, as in two-byte mode.
/// @param decimals   decimals of process value and set point: a setting of the controller, 1 for a
///                   K thermocouple with a resolution of 0.1 degC.
/// @return           std::nullopt unless there are kMonitorCount registers.
[[nodiscard]] std::optional<ControllerValues> controller_values(
    std::span<const std::uint16_t> registers, int decimals);

/// Returns true if the status reports an error of the input, of its converter or of its range.
[[nodiscard]] bool has_input_error(std::uint16_t status) noexcept;

}  // namespace a351::oven
