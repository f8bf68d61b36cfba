#include "sim/oven/modbus_frame.hpp"

#include <cassert>

namespace a351::sim::oven {

std::uint16_t modbus_crc(std::span<const std::byte> bytes) noexcept {
    std::uint16_t crc = 0xFFFF;
    for (const std::byte byte : bytes) {
        crc = static_cast<std::uint16_t>(crc ^ std::to_integer<std::uint16_t>(byte));
        for (int bit = 0; bit < 8; ++bit)
            crc = static_cast<std::uint16_t>((crc & 1U) != 0 ? crc >> 1 ^ 0xA001 : crc >> 1);
    }
    return crc;
}

std::vector<std::byte> sealed(std::vector<std::byte> frame) {
    const std::uint16_t crc = modbus_crc(frame);
    frame.push_back(static_cast<std::byte>(crc & 0xFF));
    frame.push_back(static_cast<std::byte>(crc >> 8));
    return frame;
}

bool is_sealed(std::span<const std::byte> frame) noexcept {
    // The CRC of a frame including its own CRC is 0.
    return frame.size() >= 4 && modbus_crc(frame) == 0;
}

bool is_known_function(std::byte function) noexcept {
    return function == kReadRegisters || function == kWriteRegister || function == kEcho ||
           function == kWriteRegisters;
}

std::optional<std::size_t> request_length(std::span<const std::byte> begin) noexcept {
    if (begin.size() < 2) return std::nullopt;
    const std::byte function = begin[1];
    if (function == kReadRegisters || function == kWriteRegister || function == kEcho) return 8;
    if (function == kWriteRegisters && begin.size() > 6)
        return 9 + std::to_integer<std::size_t>(begin[6]);
    return std::nullopt;
}

std::uint16_t word_at(std::span<const std::byte> frame, std::size_t offset) noexcept {
    assert(offset + 1 < frame.size());
    return static_cast<std::uint16_t>(std::to_integer<unsigned>(frame[offset]) << 8 |
                                      std::to_integer<unsigned>(frame[offset + 1]));
}

void append_word(std::vector<std::byte>& frame, std::uint16_t word) {
    frame.push_back(static_cast<std::byte>(word >> 8));
    frame.push_back(static_cast<std::byte>(word & 0xFF));
}

}  // namespace a351::sim::oven
