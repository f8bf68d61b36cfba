#include <CLI/CLI.hpp>
#include <csignal>
#include <iostream>
#include <nlohmann/json.hpp>

#include "protocol/core/input_error.hpp"
#include "sim/line/pty_device.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/signal_source.hpp"
#include "sim/survey/direct_survey.hpp"

namespace {

using namespace a351;

constexpr int kDone = 0, kFailed = 1, kBadUsage = 2;

volatile std::sig_atomic_t g_stop = 0;

void on_signal(int) { g_stop = 1; }

struct Arguments {
    std::string scenario = "tsukuba";
    std::string profile = "A351";
    std::uint64_t seed = 1;
    std::string link, clock, truth, report, out;
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

void write_report(const Arguments& arguments, const sim::StreamReport& report,
                  const sim::PtyRun& run, const sim::RegisterMachine& machine, double factor) {
    const double lateness_s = std::chrono::duration<double>(report.largest_lateness).count();
    nlohmann::ordered_json json = {
        {"scenario", arguments.scenario},
        {"seed", arguments.seed},
        {"frames_sent", report.frames_sent},
        {"runs", nlohmann::ordered_json::array()},
        {"largest_lateness_s", lateness_s},
        {"largest_lateness_real_s", lateness_s / factor},
        {"mean_rate_real_hz",
         run.real_seconds > 0.0 ? static_cast<double>(report.frames_sent) / run.real_seconds : 0.0},
        {"commands", machine.command_count()},
        {"drained", run.was_drained},
    };
    for (const auto& stay : report.runs) {
        json["runs"].push_back({{"first_index", stay.first_index}, {"frames", stay.frames}});
    }
    sim::write_text_file(arguments.report, json.dump(2) + "\n");
}

int run_device(const Arguments& arguments) {
    const sim::Scenario scenario = sim::load_scenario(arguments.scenario);
    const wire::DeviceProfile& profile = profile_of(arguments);
    sim::MachineIdentity identity;
    identity.product_id =
        arguments.product.empty() ? sim::product_id_of(profile) : arguments.product;
    identity.serial_number = arguments.serial;
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);

    std::optional<sim::TruthWriter> truth;
    if (!arguments.truth.empty()) truth.emplace(arguments.truth);
    sim::SignalSource source(scenario, profile, arguments.seed);
    sim::RegisterMachine machine(profile, identity, sim::steady_now());
    sim::DeviceStream stream(source, machine, [&truth](const sim::TruthRecord& record) {
        if (truth) truth->append(record);
    });
    sim::Pty pty(arguments.link);
    const ClockScale clock = clock_of(arguments, scenario);
    const sim::PtyRun run = sim::serve(pty, stream, clock, [] { return g_stop != 0; });
    if (truth) truth->close();
    if (!arguments.report.empty()) {
        write_report(arguments, stream.report(), run, machine, clock.factor);
    }
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
    std::filesystem::create_directories(arguments.out);
    sim::write_plan(scenario, sim::plan_survey(scenario, arguments.seed), arguments.out);
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
        command
            ->add_option("--scenario", arguments.scenario, "tsukuba, tilted, ideal, or a TOML file")
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
    CLI::Option* clock =
        device->add_option("--clock", arguments.clock, "Simulated time, scaled:FACTOR@UTC[,HOST]");
    device->add_option("--speed", arguments.speed, "Simulated seconds per second from now on")
        ->check(CLI::Range(1e-3, 1e6))
        ->excludes(clock)
        ->capture_default_str();
    device->add_option("--truth", arguments.truth, "File for the frames as sent");
    device->add_option("--report", arguments.report, "JSON file written at the end");
    device->add_option("--product", arguments.product, "Product identifier")->check(characters(8));
    device->add_option("--serial", arguments.serial, "Serial number")
        ->check(characters(8))
        ->capture_default_str();

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
