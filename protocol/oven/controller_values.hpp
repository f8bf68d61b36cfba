#pragma once
/// @file
/// Meaning of the controller's registers.  No I/O.
///
/// One poll is a read of kMonitorCount registers from kFirstMonitor on (registers.hpp).
///
///     // 42.5 degC, heating on, set point 42.5 degC, 0 A, drive 25.0 %
///     const std::array<std::uint16_t, 5> poll{0x01A9, 0x0100, 0x01A9, 0x0000, 0x00FA};
///     const auto values = controller_values(poll, 1);

#include <cstdint>
#include <optional>
#include <span>

#include "protocol/core/units.hpp"
#include "protocol/oven/registers.hpp"

namespace a351::oven {

/// Values of one poll of the controller.  The heater current is not among them.
struct ControllerValues {
    /// Absent if the status reports an input error.  No manual defines the register's value then;
    /// mostly it is an end of the range.
    std::optional<DegC> process_value;
    /// Set point in force; valid also with an input error.
    DegC set_point;
    /// Drive of the heater, -5.0 to 105.0 %; 100 % is full power.
    Percent heating;
    /// Lower 16 bits of the status, unchanged: test them with the bits of registers.hpp.
    std::uint16_t status = 0;
};

/// Converts the registers of one read to values.
///
///     value = register as a signed number / 10^decimals
///
/// The drive always has one decimal.  Each value is the double nearest to the number on the display
/// (controller_values_test.cpp).  The range of the values is not checked.
/// @param registers  from kFirstMonitor on, as in two-byte mode.  In four-byte mode pass the low
///                   word of each variable.
/// @param decimals   decimals of process value and set point: a setting of the controller, 1 for a
///                   K thermocouple with a resolution of 0.1 degC.  Range 0 to kMostDecimals; not
///                   checked.
/// @return           std::nullopt unless there are kMonitorCount registers.
[[nodiscard]] std::optional<ControllerValues> controller_values(
    std::span<const std::uint16_t> registers, int decimals);

/// Returns true if the status reports an error of the input, of its converter or of its range.  The
/// process value is then not a temperature.  The bits are kInputError, kAdConverterError and
/// kDisplayRangeExceeded; all other bits are not errors of the input.
[[nodiscard]] bool has_input_error(std::uint16_t status) noexcept;

}  // namespace a351::oven
