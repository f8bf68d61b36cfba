#pragma once

#include <functional>
#include <string>

#include "sim/command/options.hpp"

namespace a351::sim {

/// Options of `a351-sim device`, which serves the sensor and, on request, the oven on
/// pseudo-terminals.
struct DeviceCommand {
    DayOptions day;
    UnitOptions unit;
    std::uint16_t firmware = 1;
    bool lacks_id_register = false;
    std::string state;  ///< File of the flash memory.  Here and below, an empty path means none.
    std::string link, oven_link;
    std::string clock;
    double speed = 1.0;
    std::string truth, report, faults, control;
};

/// @return  the subcommand; `command` must outlive its parsing.
CLI::App* add_device(CLI::App& app, DeviceCommand& command);

/// Serves the scenario until it has ended and the host has read it, or `should_stop` returns true.
/// @throws InputError         invalid scenario, fault script, state, clock, link or socket.
/// @throws std::system_error  an operation on a terminal or a file failed.
void run(const DeviceCommand& command, const std::function<bool()>& should_stop);

}  // namespace a351::sim
