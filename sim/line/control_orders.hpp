#pragma once

#include <functional>
#include <string>

#include "sim/line/fault.hpp"

namespace a351::sim {

/// What can be ordered through the control socket.
struct ControlActions {
    std::function<std::string()> status;      ///< The report so far, in one line.
    std::function<void()> edge;               ///< At the device's pin EXT.
    std::function<void()> quit;               ///< As SIGTERM.
    std::function<void(const Fault&)> fault;  ///< Now.
};

/// Does what the line says: `status`, `edge`, `quit`, or a fault in the words of a script,
/// `flip_bit count=3`.
/// @return what there is to say about it.
/// @throws InputError  as parse_fault, or thrown by the action.
[[nodiscard]] std::string obey(const std::string& line, const ControlActions& actions,
                               const FaultRules& rules);

}  // namespace a351::sim
