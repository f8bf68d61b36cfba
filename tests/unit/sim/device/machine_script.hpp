#pragma once

#include <cctype>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "sim/device/register_machine.hpp"

namespace a351::sim {

/// "FE 01 0D" -> three bytes.
inline std::vector<std::byte> bytes_of(std::string_view hex) {
    std::vector<std::byte> bytes;
    for (std::size_t i = 0; i + 1 < hex.size();) {
        if (hex[i] == ' ') {
            ++i;
            continue;
        }
        bytes.push_back(
            static_cast<std::byte>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
        i += 2;
    }
    return bytes;
}

inline std::string hex_of(std::span<const std::byte> bytes) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    std::string hex;
    for (const std::byte byte : bytes) {
        if (!hex.empty()) hex += ' ';
        hex += kDigits[std::to_integer<std::size_t>(byte >> 4)];
        hex += kDigits[std::to_integer<std::size_t>(byte & std::byte{0x0F})];
    }
    return hex;
}

/// A machine with a clock that the test moves.
struct Bench {
    explicit Bench(std::string_view profile = "A352AD10",
                   MachineIdentity identity = {"A352AD10", "01234567", 0x000D})
        : machine(*wire::find_profile(profile), std::move(identity), Nanoseconds(0)) {
        now = RegisterMachine::kPowerOnTime;
    }

    /// Sends whole commands, given as their first two bytes; returns the answers as hex.
    std::string send(std::initializer_list<std::string_view> commands) {
        std::vector<std::byte> answers;
        for (const std::string_view command : commands) {
            machine.receive(bytes_of(std::string(command) + " 0D"), now, answers);
            now += std::chrono::milliseconds(1);
        }
        return hex_of(answers);
    }

    /// As the recorder: 50 Hz, 512 taps at 9 Hz, automatic frames with every field.
    void start_logging() {
        send({"FE 01", "85 06", "86 06", "88 01", "8C 03", "8D C7", "FE 00", "83 01"});
    }

    RegisterMachine machine;
    Nanoseconds now{0};
};

}  // namespace a351::sim
