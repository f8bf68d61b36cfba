#pragma once
/// @file
/// The part of the temperature controller's variable area that is read.  In two-byte mode a variable
/// is one register, signed, decimal point removed; in four-byte mode two, the high word first.
/// Omron E5_C Communications Manual (H175-E1), section 5; E5CN/AN/EN (H158), their -H line (H159),
/// E5_C-T (H186) and E5_D (H225) share it.  E5CN of before 2008 know four-byte mode only.

#include <cstddef>
#include <cstdint>

namespace a351::oven {

/// Where a variable is found in either mode.
struct Address {
    std::uint16_t two_byte, four_byte;
};

/// One read from here on gives a consistent picture, in the order of `Monitor`.
inline constexpr Address kFirstMonitor{0x2000, 0x0000};

/// What each register of that read holds.
enum class Monitor : std::uint8_t {
    process_value,   ///< In the input's unit, degC here.
    status,          ///< The lower 16 bits.
    set_point,       ///< The one in force; unit and decimals of the process value.
    heater_current,  ///< 0.1 A.
    heating,         ///< Drive of the heater, 0.1 %; -5.0 ... 105.0.
};
inline constexpr std::size_t kMonitorCount = 5;

/// Decimals of process value and set point; not every model has it.
inline constexpr Address kDecimalPoint{0x2410, 0x0420};
inline constexpr std::uint16_t kMostDecimals = 3;

/// Bits of the status.  With one of the first three the process value is no temperature.
inline constexpr std::uint16_t kAdConverterError = 1U << 2;
inline constexpr std::uint16_t kDisplayRangeExceeded = 1U
                                                       << 5;  ///< -H line; a spare bit elsewhere.
inline constexpr std::uint16_t kInputError = 1U << 6;         ///< Thermocouple open, out of range.
inline constexpr std::uint16_t kHeatingOutput = 1U << 8;

}  // namespace a351::oven
