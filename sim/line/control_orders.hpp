#pragma once

#include <functional>
#include <string>

#include "sim/line/fault.hpp"

namespace a351::sim {

/// Actions for the orders of the control socket.
struct ControlActions {
    std::function<std::string()> status;      ///< Returns the report so far, in one line.
    std::function<void()> edge;               ///< Gives an edge at the device's pin EXT.
    std::function<void()> quit;               ///< Ends the emulator, as SIGTERM does.
    std::function<void(const Fault&)> fault;  ///< Applies the fault now.
};

/// Executes an order: `status`, `edge`, `quit`, or a fault with the names of a script, such as
/// `flip_bit count=3`.
/// @return the answer of `status`, otherwise empty.
/// @throws InputError  as parse_fault(); also every exception of the action.
[[nodiscard]] std::string execute(const std::string& line, const ControlActions& actions,
                                  const FaultRules& rules);

}  // namespace a351::sim
