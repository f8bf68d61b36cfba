#pragma once
/// @file
/// Options shared by the commands of a351-sim.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "protocol/core/clock_scale.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::sim::command {

/// Scenario and seed, which together determine a simulated day.
struct DayOptions {
    std::string scenario = "tsukuba";
    std::uint64_t seed = 1;
};

/// Adds --scenario and --seed.
void add_day(CLI::App& command, DayOptions& day);

/// The emulated unit.
struct UnitOptions {
    std::string profile = "A351";
    std::string product;  ///< Empty: that of the profile.
    std::string serial = "00000001";
};

/// Adds --profile.
/// @param restriction  ends the description: the inputs to which the option applies.
void add_profile(CLI::App& command, std::string& profile, const std::string& restriction = {});
/// Adds --serial.
void add_serial(CLI::App& command, std::string& serial, const std::string& restriction = {});
/// Adds --profile, --product and --serial.
void add_unit(CLI::App& command, UnitOptions& unit, const std::string& restriction = {});

/// Returns the profile of that name, or the one in that file.
/// @throws InputError  there is none, the file breaks the format, or the emulator cannot use it.
[[nodiscard]] const wire::DeviceProfile& profile_of(const std::string& name_or_file);
[[nodiscard]] std::string product_of(const UnitOptions& unit);

/// Adds --clock; its syntax is that of parse_clock_scale().
CLI::Option* add_clock(CLI::App& command, std::string& clock);

/// Returns the clock of that option.  If `clock` is empty, simulated time begins now at `start` and
/// runs at `factor`.
/// @throws InputError  `clock` is neither empty nor a clock scale.
[[nodiscard]] ClockScale clock_of(const std::string& clock, double factor, UtcTime start);

}  // namespace a351::sim::command
