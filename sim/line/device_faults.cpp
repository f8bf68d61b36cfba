#include "sim/line/device_faults.hpp"

#include <algorithm>

#include "protocol/wire/commands.hpp"

namespace a351::sim {
namespace {

/// Code of a value in the high byte of its register.
std::uint16_t high_code(std::span<const wire::Coded> values, int value) {
    const auto found = std::ranges::find(values, value, &wire::Coded::value);
    return static_cast<std::uint16_t>(found->code << 8U);
}

void send(RegisterMachine& machine, const wire::CommandSequence& commands, Nanoseconds now) {
    std::vector<std::byte> unheard;
    for (const wire::Command& command : commands) machine.receive(command, now, unheard);
}

}  // namespace

void change_settings(RegisterMachine& machine, const wire::DeviceProfile& profile,
                     const Fault& fault, Nanoseconds now) {
    machine.fall_back_to_configuration();
    const auto config = *wire::ConfigMode::from_mode_ctrl(wire::kModeStatConfig);
    const auto write = [&](const wire::Register& reg, std::uint16_t value, std::uint16_t mask) {
        send(machine, config.write(reg, value, mask), now);
    };
    if (fault.output_rate_hz > 0) {
        write(wire::kSmplCtrl, high_code(profile.output_rates_hz, fault.output_rate_hz),
              wire::kHighByte);
    }
    if (!fault.filter.empty()) {
        write(wire::kFilterCtrl, profile.filter_named(fault.filter)->code, wire::kFilterSelect);
    }
    if (fault.burst_ctrl > 0) {
        write(wire::kBurstCtrl, static_cast<std::uint16_t>(fault.burst_ctrl), wire::kBothBytes);
    }
    if (fault.baud > 0) {
        write(wire::kUartCtrl, high_code(profile.baud_rates, fault.baud), wire::kHighByte);
    }
    send(machine, wire::ConfigMode(config).start_sampling().second, now);
}

void clear_diagnostics(RegisterMachine& machine, Nanoseconds now) {
    const auto config = *wire::ConfigMode::from_mode_ctrl(wire::kModeStatConfig);
    send(machine, config.read(wire::kDiagStat), now);
}

}  // namespace a351::sim
