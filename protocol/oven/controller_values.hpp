#pragma once
/// @file
/// What the controller's registers mean.  No I/O.

#include <cstdint>
#include <optional>
#include <span>

#include "protocol/core/units.hpp"
#include "protocol/oven/registers.hpp"

namespace a351::oven {

/// One look at the controller.
struct ControllerValues {
    /// Absent when the status says that the input is not to be believed.  What the register shows
    /// then is settled by no manual: mostly an end of the range.
    std::optional<DegC> process_value;
    DegC set_point;
    Percent heating;
    std::uint16_t status = 0;
};

/// @param registers  from kFirstMonitor on, as in two-byte mode.
/// @param decimals   of process value and set point: a setting of the controller, 1 for a K couple
///                   with a resolution of 0.1 degC.
/// @return           std::nullopt unless there are kMonitorCount registers.
[[nodiscard]] std::optional<ControllerValues> controller_values(
    std::span<const std::uint16_t> registers, int decimals);

/// The status names an error of the input, of its converter or of its range.
[[nodiscard]] bool has_input_error(std::uint16_t status) noexcept;

}  // namespace a351::oven
