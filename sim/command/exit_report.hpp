#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim/line/fault_injector.hpp"
#include "sim/line/line.hpp"
#include "sim/oven/modbus_server.hpp"

namespace a351::sim {

/// What the emulator did, for tests to hold against what a host counted.
struct ExitReport {
    std::string scenario;
    std::uint64_t seed = 0;
    double speed = 1.0;         ///< Simulated seconds per second.
    double real_seconds = 0.0;  ///< From the first frame handed over to the last.
    std::uint64_t commands = 0;
    bool was_drained = false;      ///< At the end the host had read everything.
    std::size_t bytes_unread = 0;  ///< When the port was pulled out, and at the end.
    LineReport line;
    FaultReport faults;
    std::optional<OvenReport> oven;  ///< If it was served.
};

/// One JSON object; keys: a351-sim(1), REPORT.
/// @param indent  spaces; negative: all in one line.
[[nodiscard]] std::string to_json(const ExitReport& report, int indent);

}  // namespace a351::sim
