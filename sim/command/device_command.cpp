#include <fmt/core.h>

#include <exception>
#include <initializer_list>
#include <iostream>
#include <memory>
#include <system_error>

#include "protocol/core/input_error.hpp"
#include "sim/command/commands.hpp"
#include "sim/command/exit_report.hpp"
#include "sim/command/options.hpp"
#include "sim/device/device_stream.hpp"
#include "sim/device/flash_memory.hpp"
#include "sim/line/control_socket.hpp"
#include "sim/line/place.hpp"
#include "sim/line/sensor_port.hpp"
#include "sim/oven/oven_port.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/signal_source.hpp"

namespace a351::sim::command {
namespace {

struct DeviceCommand {
    DayOptions day;
    UnitOptions unit;
    std::uint16_t firmware = 1;
    bool lacks_id_register = false;
    std::string state;  ///< File of the flash memory.  Here and below, an empty path means none.
    std::string link, oven_link, outer_oven_link;
    std::string clock;
    double speed = 1.0;
    std::string truth, report, faults, control;
};

/// Returns a store that writes the flash memory to `file`; the device reports a failure as
/// FLASH_BU_ERR.
device::RegisterMachine::FlashStore store_in(const std::string& file) {
    return [file](const device::FlashMemory& memory) {
        try {
            device::write_flash_file(file, memory);
        } catch (const std::system_error&) {
            return false;
        }
        return true;
    };
}

/// Checks every path before any file, socket or terminal is made.
void check_paths(const DeviceCommand& command) {
    line::Pty::require_place(command.link);
    for (const std::string& link : {command.oven_link, command.outer_oven_link})
        if (!link.empty()) line::Pty::require_place(link);
    if (!command.control.empty()) line::ControlSocket::require_place(command.control);
    for (const std::string& file : {command.truth, command.report, command.state}) {
        if (!file.empty()) line::require_file_place(file);
    }
    if (!command.truth.empty()) truth::Writer::require_own(command.truth);
}

/// Runs every step even if others fail; then throws the first error.
void take_all(std::initializer_list<std::function<void()>> steps) {
    std::exception_ptr trouble;
    for (const auto& step : steps) {
        try {
            step();
        } catch (...) {
            if (!trouble) trouble = std::current_exception();
        }
    }
    if (trouble) std::rethrow_exception(trouble);
}

void say(const std::string& trouble) { std::cerr << "a351-sim: " << trouble << std::endl; }

void run(const DeviceCommand& command, const std::function<bool()>& should_stop) {
    check_paths(command);
    const scenario::Scenario scenario = scenario::load_scenario(command.day.scenario);
    if (!command.outer_oven_link.empty() && !scenario.outer_oven) {
        throw InputError(
            fmt::format("--outer-oven-link {}: the scenario {} has no outer oven; "
                        "allowed: a scenario with [outer_oven]",
                        command.outer_oven_link, scenario.name));
    }
    const wire::DeviceProfile& profile = profile_of(command.unit.profile);
    const device::MachineIdentity identity{product_of(command.unit), command.unit.serial,
                                           command.firmware, !command.lacks_id_register};
    const device::FlashMemory flash = command.state.empty()
                                          ? device::FlashMemory()
                                          : device::read_flash_file(command.state, profile);
    const ClockScale clock = clock_of(command.clock, command.speed, scenario.start());
    if (clock.simulated(line::host_now()) >= scenario.end())
        throw InputError(fmt::format(
            "--clock {}: after the end of the scenario {}; allowed: a time from {} to {}",
            command.clock, scenario.name, to_rfc3339(scenario.start()),
            to_rfc3339(scenario.end())));
    line::FaultRules rules{profile, clock.factor};
    if (!command.oven_link.empty()) rules.oven_kinds = oven::Port::fault_kinds();
    line::FaultScript script;
    if (!command.faults.empty())
        script = line::read_fault_script(command.faults, scenario.start(), rules);

    line::Pty pty(command.link);
    std::optional<truth::Writer> truth;
    signal::Source source(scenario, profile, command.day.seed);
    device::RegisterMachine machine(profile, identity, line::steady_now(), flash);
    if (!command.state.empty()) machine.on_flash_written(store_in(command.state));
    device::DeviceStream stream(source, machine);
    line::Line line(scenario.line, command.day.seed, scenario.start(),
                    [&truth](const truth::Record& record) {
                        if (truth) truth->append(record);
                    });
    std::optional<oven::Port> oven, outer_oven;
    if (!command.oven_link.empty()) oven.emplace(command.oven_link, source.oven());
    if (!command.outer_oven_link.empty())
        outer_oven.emplace(command.outer_oven_link, *source.outer_oven());
    line::FaultInjector faults(script, scenario.start(), line, machine, profile, identity,
                               [&oven](std::string_view kind, int count) {
                                   return oven && oven->apply_fault(kind, count);
                               });
    line::SensorPort port(pty, stream, line, &faults, say);

    const auto report = [&] {
        return ExitReport{command.day.scenario,
                          command.day.seed,
                          clock.factor,
                          port.real_seconds(),
                          machine.command_count(),
                          port.was_drained(),
                          port.bytes_unread(),
                          line.report(),
                          faults.report(),
                          oven ? std::optional(oven->report()) : std::nullopt,
                          outer_oven ? std::optional(outer_oven->report()) : std::nullopt};
    };
    bool is_asked_to_quit = false;
    const line::ControlActions actions{
        [&report] { return to_json(report(), -1); },
        [&machine] { machine.external_edge(line::steady_now()); },
        [&is_asked_to_quit] { is_asked_to_quit = true; },
        [&](const line::Fault& fault) { faults.apply(fault, clock.simulated(line::host_now())); }};
    std::optional<line::ControlSocket> control;
    if (!command.control.empty()) {
        control.emplace(command.control, [&](const std::string& order) {
            return line::execute(order, actions, rules);
        });
    }

    if (!command.truth.empty()) truth.emplace(command.truth);

    std::vector<line::Service*> services{&port};
    if (oven) services.push_back(&*oven);
    if (outer_oven) services.push_back(&*outer_oven);
    if (control) services.push_back(&*control);
    const auto should_end = [&] { return is_asked_to_quit || should_stop() || port.is_finished(); };
    const auto write_report = [&] {
        if (!command.report.empty())
            scenario::write_text_file(command.report, to_json(report(), 2) + "\n");
    };
    take_all({[&] { line::attend(services, clock, should_end); },
              [&] { port.finish(clock.simulated(line::host_now())); },
              [&] {
                  if (truth) truth->close();
              },
              write_report});
}

}  // namespace

void add_device_command(CLI::App& app, UntilStopped until_stopped) {
    const auto command = std::make_shared<DeviceCommand>();
    CLI::App* device =
        app.add_subcommand("device", "Serves the emulated sensor on a pseudo-terminal.");
    add_day(*device, command->day);
    add_unit(*device, command->unit);
    device->add_option("--firmware", command->firmware, "Firmware version")
        ->type_name("N")
        ->capture_default_str();
    device->add_flag("--no-id", command->lacks_id_register,
                     "Let the register W0:4C, which the data sheet does not have, read 0");
    device
        ->add_option("--state", command->state,
                     "TOML file that keeps the flash memory between runs; default: nothing is kept")
        ->type_name("FILE");
    device
        ->add_option("--link", command->link,
                     "Symbolic link to make to the sensor's pseudo-terminal")
        ->type_name("PATH")
        ->required();
    device
        ->add_option(
            "--oven-link", command->oven_link,
            "Symbolic link to make to the pseudo-terminal of the oven's controller; default: "
            "none")
        ->type_name("PATH");
    device
        ->add_option("--outer-oven-link", command->outer_oven_link,
                     "The same for the controller of the outer oven, if the scenario has one; "
                     "default: none")
        ->type_name("PATH");
    CLI::Option* clock = add_clock(*device, command->clock);
    device
        ->add_option("--speed", command->speed,
                     "Simulated seconds per real second, from the start of the scenario on")
        ->type_name("X")
        ->check(CLI::Range(1e-3, 1e6))
        ->excludes(clock)
        ->capture_default_str();
    device->add_option("--truth", command->truth, "File to write: every frame and its fate")
        ->type_name("FILE");
    device->add_option("--report", command->report, "JSON file to write at the end")
        ->type_name("FILE");
    device->add_option("--faults", command->faults, "TOML file with faults and their times")
        ->type_name("FILE");
    device
        ->add_option("--control", command->control,
                     "Unix socket to make, which takes faults and orders while the emulator runs")
        ->type_name("PATH");
    device->callback([command, until_stopped] { run(*command, until_stopped()); });
}

}  // namespace a351::sim::command
