#include "sim/line/device_faults.hpp"

#include <algorithm>
#include <vector>

namespace a351::sim {
namespace {

/// Returns the code of a value, shifted to the high byte of its register.
std::uint16_t high_code(std::span<const wire::Coded> values, int value) {
    const auto found = std::ranges::find(values, value, &wire::Coded::value);
    return static_cast<std::uint16_t>(found->code << 8U);
}

}  // namespace

void change_settings(RegisterMachine& machine, const wire::DeviceProfile& profile,
                     const Fault& fault, Nanoseconds now) {
    std::vector<RegisterChange> changes;
    if (fault.output_rate_hz > 0) {
        changes.push_back({wire::kSmplCtrl,
                           high_code(profile.output_rates_hz, fault.output_rate_hz),
                           wire::kHighByte});
    }
    if (!fault.filter.empty()) {
        changes.push_back(
            {wire::kFilterCtrl, profile.filter_named(fault.filter)->code, wire::kFilterSelect});
    }
    if (fault.burst_ctrl > 0) {
        changes.push_back({wire::kBurstCtrl, static_cast<std::uint16_t>(fault.burst_ctrl)});
    }
    if (fault.baud > 0) {
        changes.push_back(
            {wire::kUartCtrl, high_code(profile.baud_rates, fault.baud), wire::kHighByte});
    }
    machine.apply_settings(changes, now);
}

}  // namespace a351::sim
