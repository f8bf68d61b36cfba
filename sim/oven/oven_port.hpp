#pragma once

#include <filesystem>
#include <string_view>

#include "sim/line/pty.hpp"
#include "sim/line/service.hpp"
#include "sim/oven/modbus_server.hpp"

namespace a351::sim::oven {

/// The oven's controller on its own pseudo-terminal.  The baud rates of terminal and controller
/// must agree, otherwise nothing is understood.  Parity is ignored, because a pseudo-terminal has
/// none.
class Port final : public line::Service {
public:
    /// @param plant  must outlive this.
    /// @throws  as Pty.
    Port(std::filesystem::path link, plant::OvenPlant& plant);

    void serve(const device::Instant& now) override;
    void watch(std::vector<pollfd>& descriptors) const override;
    [[nodiscard]] Nanoseconds patience(const device::Instant& now,
                                       const ClockScale& clock) const override;

    /// Applies a fault by name:
    /// - `oven_silence`, `oven_babble`, `oven_exception`, `oven_crc_error`, `oven_wrong_unit`,
    ///   `oven_truncated`, `oven_delay`: faults of the next `count` answers; -1: of all answers
    ///   from now on; 0: of none any more.
    /// - `oven_sensor_break`: breaks the sensor; `count` 0 repairs it.
    /// - `oven_unplug`: hangs the terminal up and removes its link; `count` 0 plugs it in again
    ///   under another name.
    /// - `oven_power_cycle`: switches off and on now, for any count.
    /// @return false if there is no such fault.
    /// @throws InputError  something else is at the path of the link.
    bool apply_fault(std::string_view kind, int count);

    /// Returns these names; first the faults of answers, in the order of Fault.
    [[nodiscard]] static std::vector<std::string_view> fault_kinds();

    [[nodiscard]] const Report& report() const noexcept { return server_.report(); }

private:
    void send(const std::vector<std::byte>& answer);
    void unplug(bool is_out);

    plant::OvenPlant& plant_;
    Controller controller_;
    ModbusServer server_;
    line::Pty pty_;
    bool is_unplugged_ = false;
    bool wants_power_cycle_ = false;  ///< Done at the next serve(), which has the time.
    std::vector<std::byte> unsent_;
};

}  // namespace a351::sim::oven
