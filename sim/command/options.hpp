#pragma once
/// @file
/// Options that several commands of a351-sim have.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "protocol/core/clock_scale.hpp"
#include "protocol/wire/device_profile.hpp"

namespace a351::sim {

/// A scenario and the day that the seed makes of it.
struct DayOptions {
    std::string scenario = "tsukuba";
    std::uint64_t seed = 1;
};
void add_day(CLI::App& command, DayOptions& day);

/// Which unit is emulated.
struct UnitOptions {
    std::string profile = "A351";
    std::string product;  ///< Empty: what the profile calls itself.
    std::string serial = "00000001";
};

/// @param used_for  what of the command the options are for; begins their descriptions.
void add_profile(CLI::App& command, std::string& profile, const std::string& used_for = {});
void add_unit(CLI::App& command, UnitOptions& unit, const std::string& used_for = {});

[[nodiscard]] const wire::DeviceProfile& profile_of(const std::string& name);
[[nodiscard]] std::string product_of(const UnitOptions& unit);

/// `--clock`, in the words of parse_clock_scale().
CLI::Option* add_clock(CLI::App& command, std::string& clock);

/// The clock of that option; if it is empty, one that leaves `start` now at `factor`.
/// @throws InputError  it is no clock.
[[nodiscard]] ClockScale clock_of(const std::string& clock, double factor, UtcTime start);

}  // namespace a351::sim
