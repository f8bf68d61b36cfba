#pragma once
/// @file
/// The part of the temperature controller's variable area that is read.  In two-byte mode a
/// variable is one register, signed, decimal point removed; in four-byte mode two, high word first.
/// Omron E5_C Communications Manual (H175-E1), section 5; E5CN/AN/EN (H158), their -H line (H159),
/// E5_C-T (H186) and E5_D (H225) share it.  E5CN made before 2008 have four-byte mode only.
///
/// Read in two-byte mode first.  If the controller answers with the exception "illegal data
/// address", read in four-byte mode and keep the low words, which are the registers of two-byte
/// mode.  controller_values.hpp converts them.

#include <cstddef>
#include <cstdint>

namespace a351::oven {

/// Address of a variable in each mode: the first register in a request of Modbus function 03.  A
/// read of n variables has n registers in two-byte mode and 2 n in four-byte mode.
struct Address {
    std::uint16_t two_byte, four_byte;
};

/// First of the monitored variables.  One read from here on gives consistent values, in the order
/// of `Monitor`.
inline constexpr Address kFirstMonitor{0x2000, 0x0000};

/// Content of each register of that read.  The value of an enumerator is the position of its
/// register, from 0.
enum class Monitor : std::uint8_t {
    process_value,   ///< Measured value in the unit of the input, degC here.
    status,          ///< Lower 16 bits of the status.
    set_point,       ///< Set point in force; unit and decimals of the process value.
    heater_current,  ///< 0.1 A.
    heating,         ///< Drive of the heater, 0.1 %; -5.0 ... 105.0.
};
/// Number of variables in that read.
inline constexpr std::size_t kMonitorCount = 5;

/// Number of decimals of process value and set point; not every model has this variable.  A model
/// without it answers with an exception: use a configured number then.
inline constexpr Address kDecimalPoint{0x2410, 0x0420};
/// Largest number of decimals that is accepted.  Use a configured number if the answer is larger.
inline constexpr std::uint16_t kMostDecimals = 3;

/// Bits of the status.  With one of the first three the process value is not a temperature.
/// has_input_error() of controller_values.hpp tests the three together.
inline constexpr std::uint16_t kAdConverterError = 1U << 2;
inline constexpr std::uint16_t kDisplayRangeExceeded = 1U << 5;  ///< -H line; unused elsewhere.
inline constexpr std::uint16_t kInputError = 1U << 6;  ///< Thermocouple open, out of range.
/// Heating output is on.  This is no error, and its absence neither.
inline constexpr std::uint16_t kHeatingOutput = 1U << 8;

}  // namespace a351::oven
