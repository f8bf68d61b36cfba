#pragma once
/// @file
/// The variable area of the temperature controller: addresses, variables and write access.  Omron
/// E5_C Communications Manual (H175-E1), section 5, the part that the E5_C-T, E5_D and 2008 E5xN
/// models share with it.
///
/// Every variable has two addresses: below 2000h it is two registers, high word first ("four-byte
/// mode"); from 2000h on it is a single register ("two-byte mode").

#include <cstdint>
#include <optional>

namespace a351::sim::oven {

enum class Variable {
    process_value,
    status,
    status_high,  ///< Two-byte mode only: the upper half of the status.
    internal_set_point,
    heater_current,
    drive_heating,
    drive_cooling,
    set_point,
    alarm_1,
    alarm_1_upper,
    alarm_1_lower,
    status_2,
    status_2_high,  ///< Two-byte mode only.
    decimal_point,
    input_filter,
    proportional_band,
    integral_time,
    derivative_time,
    input_type,
    control_kind,
};

enum class WriteLevel {
    none,       ///< Read only.
    operation,  ///< Writable while control runs.
    setup       ///< Writable only in setup area 1, in which control is stopped.
};

struct VariableEntry {
    Variable variable;
    WriteLevel level;
    std::optional<std::uint16_t> four_byte;
    std::uint16_t two_byte;
};

inline constexpr std::uint16_t kFirstTwoByteAddress = 0x2000;

[[nodiscard]] constexpr bool is_two_byte_address(std::uint16_t address) noexcept {
    return address >= kFirstTwoByteAddress;
}

/// Returns the entry of an address.
/// @return  null if the map has no variable there; also for an odd address of four-byte mode.
[[nodiscard]] const VariableEntry* find_variable(std::uint16_t address) noexcept;

}  // namespace a351::sim::oven
