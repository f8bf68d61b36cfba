#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim/line/fault_injector.hpp"
#include "sim/line/line.hpp"
#include "sim/oven/modbus_server.hpp"

namespace a351::sim::command {

/// Counts of the emulator's actions; tests compare them with the counts of a host.
struct ExitReport {
    std::string scenario;
    std::uint64_t seed = 0;
    double speed = 1.0;         ///< Simulated seconds per real second.
    double real_seconds = 0.0;  ///< Real time from the first frame handed over to the last.
    std::uint64_t commands = 0;
    bool was_drained = false;      ///< Nothing was under way at the end, and the host had read all.
    std::size_t bytes_unread = 0;  ///< Not read by the host at hang-ups and at the end.
    line::Report line;
    line::FaultReport faults;
    std::optional<oven::Report> oven;  ///< Empty: the oven was not served.
    std::optional<oven::Report> outer_oven;
};

/// Returns the report as one JSON object; keys: a351-sim-device(1), REPORT.
/// @param indent  spaces per level; negative: everything in one line.
[[nodiscard]] std::string to_json(const ExitReport& report, int indent);

}  // namespace a351::sim::command
