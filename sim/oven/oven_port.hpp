#pragma once

#include <filesystem>
#include <string_view>

#include "sim/line/pty.hpp"
#include "sim/line/service.hpp"
#include "sim/oven/modbus_server.hpp"

namespace a351::sim {

struct OvenOptions {
    ControllerOptions controller;
    ServerOptions server;
};

/// The oven's controller on a pseudo-terminal of its own.  The terminal's speed must be the
/// controller's, or nothing is understood; its parity is not looked at, for a pseudo-terminal
/// carries none.
class OvenPort final : public Service {
public:
    /// @param plant  must outlive this.
    /// @throws  as Pty.
    OvenPort(std::filesystem::path link, OvenPlant& plant, const OvenOptions& options = {});

    void serve(const Instant& now) override;
    void watch(std::vector<pollfd>& descriptors) const override;
    [[nodiscard]] Nanoseconds patience(const Instant& now, const ClockScale& clock) const override;

    /// Applies a fault by name.  `oven_silence`, `oven_babble`, `oven_exception`, `oven_crc_error`,
    /// `oven_wrong_unit`, `oven_truncated`, `oven_delay`: of the next `count` answers, of all until
    /// further notice if -1, no longer if 0.  `oven_sensor_break`: from now on, or mended if
    /// `count` is 0.  `oven_unplug`: the terminal hangs up and its link is gone, or comes back under
    /// another name if `count` is 0.  `oven_power_cycle`: now, whatever the count.
    /// @return false: there is no such fault.
    /// @throws InputError  something else has taken the place of the link.
    bool apply_fault(std::string_view kind, int count);

    /// Those names; first the spoilt answers, in the order of OvenFault.
    [[nodiscard]] static std::vector<std::string_view> fault_kinds();

    [[nodiscard]] const OvenReport& report() const noexcept { return server_.report(); }

private:
    void send(const std::vector<std::byte>& answer);
    void unplug(bool is_out);

    OvenPlant& plant_;
    OvenController controller_;
    ModbusServer server_;
    int baud_;
    Pty pty_;
    bool is_unplugged_ = false;
    bool wants_power_cycle_ = false;  ///< At the next serve(), which knows the time.
    std::vector<std::byte> unsent_;
};

}  // namespace a351::sim
