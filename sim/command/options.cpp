#include "sim/command/options.hpp"

#include <algorithm>
#include <filesystem>

#include "protocol/core/input_error.hpp"
#include "protocol/text/echo.hpp"
#include "protocol/wire/device_profile.hpp"
#include "sim/device/register_file.hpp"
#include "sim/line/service.hpp"

namespace a351::sim::command {
namespace {

CLI::Validator eight_characters() {
    return CLI::Validator(
        [](const std::string& value) {
            return value.size() == 8 ? std::string() : "not 8 characters";
        },
        "8 characters");
}

}  // namespace

void add_day(CLI::App& command, DayOptions& day) {
    command.add_option("--scenario", day.scenario, "Scenario of the day: its name, or a TOML file")
        ->type_name("NAME|FILE")
        ->capture_default_str();
    command.add_option("--seed", day.seed, "Seed of all random numbers")
        ->type_name("N")
        ->capture_default_str();
}

void add_profile(CLI::App& command, std::string& profile, const std::string& restriction) {
    command
        .add_option("--profile", profile,
                    "Kind of device: name of a profile, or a TOML file" + restriction)
        ->type_name("NAME|FILE")
        ->capture_default_str();
}

void add_serial(CLI::App& command, std::string& serial, const std::string& restriction) {
    command.add_option("--serial", serial, "Serial number" + restriction)
        ->type_name("ID")
        ->check(eight_characters())
        ->capture_default_str();
}

void add_unit(CLI::App& command, UnitOptions& unit, const std::string& restriction) {
    add_profile(command, unit.profile, restriction);
    command
        .add_option("--product", unit.product,
                    "Product identifier; default: that of the profile" + restriction)
        ->type_name("ID")
        ->check(eight_characters());
    add_serial(command, unit.serial, restriction);
}

const wire::DeviceProfile& profile_of(const std::string& name_or_file) {
    const wire::DeviceProfile& profile = wire::profile_option("--profile", name_or_file);
    if (!device::has_factory_codes(profile)) {
        throw InputError(text::echoed(name_or_file) +
                         ": the emulated device cannot start with it; allowed: a profile with code "
                         "4 of output_rate, 1 of baud and 8 of filter");
    }
    return profile;
}

std::string product_of(const UnitOptions& unit) {
    return unit.product.empty() ? profile_of(unit.profile).product_id : unit.product;
}

CLI::Option* add_clock(CLI::App& command, std::string& clock) {
    return command
        .add_option("--clock", clock,
                    "Simulated time, scaled:FACTOR@UTC[,HOST]: UTC + FACTOR x (host clock - HOST); "
                    "default of HOST: now")
        ->type_name("SCALE");
}

ClockScale clock_of(const std::string& clock, double factor, UtcTime start) {
    const UtcTime now = line::host_now();
    if (clock.empty()) return {factor, start, now};
    const auto scale = parse_clock_scale(clock, now);
    if (!scale)
        throw InputError("--clock " + clock + ": not a clock; allowed: scaled:FACTOR@UTC[,HOST]");
    return *scale;
}

}  // namespace a351::sim::command
