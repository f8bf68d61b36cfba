#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/command/options.hpp"

namespace a351::sim {

/// `a351-sim replay`: a recording behind the handshake of the live device.
struct ReplayCommand {
    std::vector<std::filesystem::path> files;
    std::string link;
    std::string speed = "1";  ///< A factor, or "max".
    std::string clock;
    std::string axes = "1,2,Z";
    UnitOptions unit;  ///< Of miniSEED, which does not name it.
};

/// @return  the subcommand; `command` must outlive its parsing.
CLI::App* add_replay(CLI::App& app, ReplayCommand& command);

/// Serves the recording until it ends and the host has read it, or `should_stop` says so; then says
/// on stderr what could not be replayed.
/// @throws InputError          the files, the clock, the link.
/// @throws std::runtime_error  the host asked for settings that were not recorded.
void run(const ReplayCommand& command, const std::function<bool()>& should_stop);

}  // namespace a351::sim
