#include <CLI/CLI.hpp>
#include <csignal>
#include <iostream>

#include "protocol/core/input_error.hpp"
#include "sim/device/device_stream.hpp"
#include "sim/line/control_orders.hpp"
#include "sim/line/control_socket.hpp"
#include "sim/line/exit_report.hpp"
#include "sim/line/sensor_port.hpp"
#include "sim/oven/oven_port.hpp"
#include "sim/replay_command.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/signal_source.hpp"
#include "sim/survey/direct_survey.hpp"
#include "sim/survey/plan_files.hpp"

namespace {

using namespace a351;

constexpr int kDone = 0, kFailed = 1, kBadUsage = 2;

volatile std::sig_atomic_t g_stop = 0;

void on_signal(int) { g_stop = 1; }

struct Arguments {
    std::string scenario = "tsukuba";
    std::string profile = "A351";
    std::uint64_t seed = 1;
    std::string link, oven_link, clock, truth, report, faults, control, out;
    double speed = 1.0;
    std::string product, serial = "00000001";
};

const wire::DeviceProfile& profile_of(const Arguments& arguments) {
    return *wire::find_profile(arguments.profile);
}

ClockScale clock_of(const Arguments& arguments, const sim::Scenario& scenario) {
    const UtcTime now = sim::host_now();
    if (arguments.clock.empty()) return {arguments.speed, scenario.start(), now};
    const auto clock = parse_clock_scale(arguments.clock, now);
    if (!clock) {
        throw InputError("--clock " + arguments.clock +
                         ": not a clock; allowed: scaled:FACTOR@UTC[,HOST]");
    }
    return *clock;
}

sim::FaultRules fault_rules(const Arguments& arguments, double speed) {
    sim::FaultRules rules{profile_of(arguments), speed};
    if (!arguments.oven_link.empty()) rules.oven_kinds = sim::OvenPort::fault_kinds();
    return rules;
}

int run_device(const Arguments& arguments) {
    const sim::Scenario scenario = sim::load_scenario(arguments.scenario);
    const wire::DeviceProfile& profile = profile_of(arguments);
    sim::MachineIdentity identity;
    identity.product_id =
        arguments.product.empty() ? sim::product_id_of(profile) : arguments.product;
    identity.serial_number = arguments.serial;
    const ClockScale clock = clock_of(arguments, scenario);
    const sim::FaultRules rules = fault_rules(arguments, clock.factor);
    sim::FaultScript script;
    if (!arguments.faults.empty()) {
        script = sim::read_fault_script(arguments.faults, scenario.start(), rules);
    }
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);

    sim::Pty pty(arguments.link);
    std::optional<sim::TruthWriter> truth;
    if (!arguments.truth.empty()) truth.emplace(arguments.truth);
    sim::SignalSource source(scenario, profile, arguments.seed);
    sim::RegisterMachine machine(profile, identity, sim::steady_now());
    sim::DeviceStream stream(source, machine);
    sim::Line line(scenario.line, arguments.seed, scenario.start(),
                   [&truth](const sim::TruthRecord& record) {
                       if (truth) truth->append(record);
                   });
    std::optional<sim::OvenPort> oven;
    if (!arguments.oven_link.empty()) oven.emplace(arguments.oven_link, source.oven());
    sim::FaultInjector faults(script, scenario.start(), line, machine, profile, identity,
                              [&oven](std::string_view kind, int count) {
                                  return oven && oven->apply_fault(kind, count);
                              });
    sim::SensorPort port(pty, stream, line, &faults);
    const auto report = [&] {
        return sim::ExitReport{arguments.scenario,  arguments.seed,          clock.factor,
                               port.real_seconds(), machine.command_count(), port.was_drained(),
                               port.bytes_unread(), line.report(),           faults.report()};
    };
    const sim::ControlActions actions{
        [&report] { return sim::to_json(report(), -1); },
        [&machine] { machine.external_edge(sim::steady_now()); }, [] { g_stop = 1; },
        [&](const sim::Fault& fault) { faults.apply(fault, clock.simulated(sim::host_now())); }};
    std::optional<sim::ControlSocket> control;
    if (!arguments.control.empty()) {
        control.emplace(arguments.control,
                        [&](const std::string& order) { return sim::obey(order, actions, rules); });
    }
    std::vector<sim::Service*> services{&port};
    if (oven) services.push_back(&*oven);
    if (control) services.push_back(&*control);
    sim::attend(services, clock, [&port] { return g_stop != 0 || port.is_finished(); });
    if (truth) truth->close();
    if (!arguments.report.empty()) {
        sim::write_text_file(arguments.report, sim::to_json(report(), 2) + "\n");
    }
    return kDone;
}

int run_replay(const sim::ReplayCommand& command) {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    sim::run_replay(command, [] { return g_stop != 0; });
    return kDone;
}

int run_survey(const Arguments& arguments) {
    const auto survey = sim::write_survey(sim::load_scenario(arguments.scenario),
                                          profile_of(arguments), arguments.seed, arguments.out);
    std::cerr << survey.frames << " frames, " << survey.records << " records\n";
    return kDone;
}

int run_plan(const Arguments& arguments) {
    const sim::Scenario scenario = sim::load_scenario(arguments.scenario);
    sim::write_plan(scenario, arguments.seed, arguments.out);
    std::cout << "start_utc=" << to_rfc3339(scenario.start())
              << " end_utc=" << to_rfc3339(scenario.end()) << '\n';
    return kDone;
}

CLI::Validator characters(std::size_t count) {
    return CLI::Validator(
        [count](const std::string& value) {
            return value.size() == count ? std::string()
                                         : "not " + std::to_string(count) + " characters";
        },
        std::to_string(count) + " characters");
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app{"Emulated M-A351 accelerometer, and simulated survey days", "a351-sim"};
    app.set_version_flag("--version", "a351-sim " A351_VERSION);
    app.require_subcommand(1);

    const auto add_day = [&arguments](CLI::App* command) {
        command->add_option("--scenario", arguments.scenario, "A named scenario, or a TOML file")
            ->capture_default_str();
        command->add_option("--seed", arguments.seed, "Of all random numbers")
            ->capture_default_str();
    };
    const auto add_profile = [&arguments](CLI::App* command) {
        command->add_option("--profile", arguments.profile, "Kind of device")
            ->check(CLI::IsMember({"A351", "A352AD10"}))
            ->capture_default_str();
    };

    CLI::App* device = app.add_subcommand("device", "Serve the sensor on a pseudo-terminal");
    add_day(device);
    add_profile(device);
    device->add_option("--link", arguments.link, "Symbolic link that names the terminal")
        ->required();
    device->add_option("--oven-link", arguments.oven_link,
                       "Symbolic link that names the terminal of the oven's controller");
    CLI::Option* clock =
        device->add_option("--clock", arguments.clock, "Simulated time, scaled:FACTOR@UTC[,HOST]");
    device->add_option("--speed", arguments.speed, "Simulated seconds per second from now on")
        ->check(CLI::Range(1e-3, 1e6))
        ->excludes(clock)
        ->capture_default_str();
    device->add_option("--truth", arguments.truth, "File for the frames as sent");
    device->add_option("--report", arguments.report, "JSON file written at the end");
    device->add_option("--faults", arguments.faults, "TOML file: which faults happen when");
    device->add_option("--control", arguments.control, "Unix socket that takes faults and orders");
    device->add_option("--product", arguments.product, "Product identifier")->check(characters(8));
    device->add_option("--serial", arguments.serial, "Serial number")
        ->check(characters(8))
        ->capture_default_str();

    sim::ReplayCommand replay_command;
    const CLI::App* replay = sim::add_replay(app, replay_command);

    CLI::App* survey = app.add_subcommand("survey", "Write a day straight to a data root");
    add_day(survey);
    add_profile(survey);
    survey->add_option("--out", arguments.out, "Data root without a journal")->required();

    CLI::App* plan = app.add_subcommand("plan", "Write sites, schedule and truth of a day");
    add_day(plan);
    plan->add_option("--out", arguments.out, "Directory for the tables")->required();

    try {
        app.parse(argc, argv);
        if (device->parsed()) return run_device(arguments);
        if (replay->parsed()) return run_replay(replay_command);
        if (survey->parsed()) return run_survey(arguments);
        return run_plan(arguments);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        std::cerr << "a351-sim: " << error.what() << '\n';
        return kBadUsage;
    } catch (const InputError& error) {
        std::cerr << "a351-sim: " << error.what() << '\n';
        return kBadUsage;
    } catch (const std::exception& error) {
        std::cerr << "a351-sim: " << error.what() << '\n';
        return kFailed;
    }
}
