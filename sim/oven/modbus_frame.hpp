#pragma once
/// @file
/// Frames of Modbus RTU as bytes: Modbus over Serial Line, Specification and Implementation Guide
/// V1.02 (modbus.org), section 2.5.1, and the four functions of the Omron E5_C (H175-E1, section
/// 4).

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace a351::sim::oven {

inline constexpr std::byte kReadRegisters{0x03};
inline constexpr std::byte kWriteRegister{0x06};
inline constexpr std::byte kEcho{0x08};
inline constexpr std::byte kWriteRegisters{0x10};

/// Returns the CRC: reflected polynomial A001h, start FFFFh; it is sent low byte first.
[[nodiscard]] std::uint16_t modbus_crc(std::span<const std::byte> bytes) noexcept;

/// Returns the frame followed by its CRC.
[[nodiscard]] std::vector<std::byte> sealed(std::vector<std::byte> frame);

/// Returns true if the last two bytes are the CRC of all bytes before them.
[[nodiscard]] bool is_sealed(std::span<const std::byte> frame) noexcept;

/// Returns true for one of the four functions above.
[[nodiscard]] bool is_known_function(std::byte function) noexcept;

/// Returns the length of the request that begins with these bytes.
/// @return  std::nullopt: not known yet, or a function whose requests only silence ends.
[[nodiscard]] std::optional<std::size_t> request_length(std::span<const std::byte> begin) noexcept;

/// Returns the 16-bit word at `offset`, high byte first.
[[nodiscard]] std::uint16_t word_at(std::span<const std::byte> frame, std::size_t offset) noexcept;
void append_word(std::vector<std::byte>& frame, std::uint16_t word);

}  // namespace a351::sim::oven
