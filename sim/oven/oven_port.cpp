#include "sim/oven/oven_port.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace a351::sim::oven {
namespace {

/// Names in the order of Fault.
constexpr std::array<std::string_view, kOvenFaultCount> kAnswerFaults = {
    "oven_silence",    "oven_babble",    "oven_exception", "oven_crc_error",
    "oven_wrong_unit", "oven_truncated", "oven_delay",
};
constexpr std::string_view kSensorBreak = "oven_sensor_break";
constexpr std::string_view kUnplug = "oven_unplug";
constexpr std::string_view kPowerCycle = "oven_power_cycle";

}  // namespace

Port::Port(std::filesystem::path link, plant::OvenPlant& plant)
    : plant_(plant),
      controller_(plant),
      server_(controller_),
      pty_(std::move(link), ModbusServer::kBaud) {}

void Port::serve(const device::Instant& now) {
    if (std::exchange(wants_power_cycle_, false)) server_.restart(now.steady);
    if (is_unplugged_) {
        static_cast<void>(server_.advance_to(now.steady, false));
        return;
    }
    const std::vector<std::byte> bytes = pty_.read();
    const bool is_understood = pty_.baud() == ModbusServer::kBaud;
    if (is_understood) {
        server_.receive(bytes, now.steady);
    } else if (!bytes.empty()) {
        server_.receive_noise(now.steady);
    }
    send(server_.advance_to(now.steady, is_understood));
}

void Port::send(const std::vector<std::byte>& answer) {
    unsent_.insert(unsent_.end(), answer.begin(), answer.end());
    const std::size_t taken = unsent_.empty() ? 0 : pty_.write(unsent_);
    unsent_.erase(unsent_.begin(), unsent_.begin() + static_cast<std::ptrdiff_t>(taken));
}

void Port::unplug(bool is_out) {
    if (is_out == is_unplugged_) return;
    is_out ? pty_.hang_up() : pty_.come_back();
    is_unplugged_ = is_out;
    unsent_.clear();
}

void Port::watch(std::vector<pollfd>& descriptors) const {
    if (!is_unplugged_) descriptors.push_back(pty_.watched(!unsent_.empty()));
}

Nanoseconds Port::patience(const device::Instant& now, const ClockScale&) const {
    const std::optional<Nanoseconds> due = server_.next_due();
    if (!due) return Nanoseconds::max();
    return std::max(Nanoseconds(0), *due - now.steady);
}

bool Port::apply_fault(std::string_view kind, int count) {
    if (kind == kSensorBreak) {
        plant_.break_sensor(count != 0);
        return true;
    }
    if (kind == kUnplug) {
        unplug(count != 0);
        return true;
    }
    if (kind == kPowerCycle) {
        wants_power_cycle_ = true;
        return true;
    }
    const auto found = std::ranges::find(kAnswerFaults, kind);
    if (found == kAnswerFaults.end()) return false;
    server_.fail_next(static_cast<Fault>(found - kAnswerFaults.begin()), count);
    return true;
}

std::vector<std::string_view> Port::fault_kinds() {
    std::vector<std::string_view> kinds(kAnswerFaults.begin(), kAnswerFaults.end());
    kinds.insert(kinds.end(), {kSensorBreak, kUnplug, kPowerCycle});
    return kinds;
}

}  // namespace a351::sim::oven
