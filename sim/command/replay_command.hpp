#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/command/options.hpp"

namespace a351::sim {

/// Options of `a351-sim replay`, which serves a recording behind the handshake of the live device.
struct ReplayCommand {
    std::vector<std::filesystem::path> files;
    std::string link;
    std::string speed = "1";  ///< A factor, or "max".
    std::string clock;
    std::string axes = "1,2,Z";
    UnitOptions unit;  ///< Unit of a miniSEED recording, which does not name it.
};

/// @return  the subcommand; `command` must outlive its parsing.
CLI::App* add_replay(CLI::App& app, ReplayCommand& command);

/// Serves the recording until it has ended and the host has read it, or `should_stop` returns true.
/// Then reports on stderr what could not be replayed.
/// @throws InputError          unusable files, clock or link.
/// @throws std::runtime_error  the host asked for settings that were not recorded.
void run(const ReplayCommand& command, const std::function<bool()>& should_stop);

}  // namespace a351::sim
