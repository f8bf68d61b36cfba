#include "sim/line/control_orders.hpp"

namespace a351::sim {

std::string execute(const std::string& line, const ControlActions& actions,
                    const FaultRules& rules) {
    if (line == "status") return actions.status();
    if (line == "edge") {
        actions.edge();
    } else if (line == "quit") {
        actions.quit();
    } else {
        actions.fault(parse_fault(line, rules));
    }
    return {};
}

}  // namespace a351::sim
