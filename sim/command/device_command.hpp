#pragma once

#include <functional>
#include <string>

#include "sim/command/options.hpp"

namespace a351::sim {

/// `a351-sim device`: the sensor, and the oven if asked for, on pseudo-terminals.
struct DeviceCommand {
    DayOptions day;
    UnitOptions unit;
    std::uint16_t firmware = 1;
    bool lacks_id_register = false;
    std::string state;  ///< File of the flash memory; this and the others: empty, none.
    std::string link, oven_link;
    std::string clock;
    double speed = 1.0;
    std::string truth, report, faults, control;
};

/// @return  the subcommand; `command` must outlive its parsing.
CLI::App* add_device(CLI::App& app, DeviceCommand& command);

/// Serves the scenario until it ends and the host has read it, or `should_stop` says so.
/// @throws InputError         scenario, script, state, clock, link, socket.
/// @throws std::system_error  a terminal or a file.
void run(const DeviceCommand& command, const std::function<bool()>& should_stop);

}  // namespace a351::sim
