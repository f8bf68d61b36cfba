#pragma once
/// @file
/// The subcommands of `a351-sim`, each in NAME_command.cpp except for `plan`, which is beside
/// `survey`.

#include <CLI/CLI.hpp>
#include <functional>

namespace a351::sim::command {

/// Begins to catch the signals that end a command.  @return a predicate: true once one has arrived.
using UntilStopped = std::function<bool()> (*)();

/// `device`: serves the sensor and, on request, the oven on pseudo-terminals, until the scenario
/// has ended and the host has read it, or a signal arrives.
/// Its run throws InputError for an invalid scenario, fault script, state, clock, link or socket,
/// and std::system_error if an operation on a terminal or a file failed.
void add_device_command(CLI::App& app, UntilStopped until_stopped);

/// `replay`: serves a recording with the handshake of the live device, until it has ended and the
/// host has read it, or a signal arrives.  Then reports on stderr what could not be replayed.
/// Its run throws InputError for unusable files, clock or link, and std::runtime_error if the host
/// asked for settings that were not recorded.
void add_replay_command(CLI::App& app, UntilStopped until_stopped);

/// `survey`: writes a simulated day directly to a data root, and the numbers of frames and records
/// to stderr.  Its run throws as write_survey().
void add_survey_command(CLI::App& app);

/// `plan`: writes sites, schedule and truth of a simulated day, and prints its first and last
/// instant.  Its run throws as write_plan().
void add_plan_command(CLI::App& app);

}  // namespace a351::sim::command
