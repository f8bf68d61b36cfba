#include <csignal>
#include <iostream>

#include "protocol/core/input_error.hpp"
#include "sim/command/device_command.hpp"
#include "sim/command/replay_command.hpp"
#include "sim/command/survey_command.hpp"

namespace {

constexpr int kDone = 0, kFailed = 1, kBadUsage = 2;

volatile std::sig_atomic_t g_stop = 0;

void on_signal(int) { g_stop = 1; }

/// Catches SIGINT and SIGTERM; the returned predicate is true once either has arrived.
bool (*until_stopped())() {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    return [] { return g_stop != 0; };
}

int fail(const char* reason, int status) {
    std::cerr << "a351-sim: " << reason << '\n';
    return status;
}

}  // namespace

int main(int argc, char** argv) {
    using namespace a351;
    CLI::App app{"Emulated M-A351 accelerometer, and simulated survey days", "a351-sim"};
    app.set_version_flag("--version", "a351-sim " A351_VERSION);
    app.require_subcommand(1);
    sim::DeviceCommand device_command;
    sim::ReplayCommand replay_command;
    sim::SurveyCommand survey_command;
    sim::PlanCommand plan_command;
    const CLI::App* device = sim::add_device(app, device_command);
    const CLI::App* replay = sim::add_replay(app, replay_command);
    const CLI::App* survey = sim::add_survey(app, survey_command);
    const CLI::App* plan = sim::add_plan(app, plan_command);
    try {
        app.parse(argc, argv);
        if (device->parsed()) sim::run(device_command, until_stopped());
        if (replay->parsed()) sim::run(replay_command, until_stopped());
        if (survey->parsed()) sim::run(survey_command);
        if (plan->parsed()) sim::run(plan_command);
        return kDone;
    } catch (const CLI::ParseError& error) {
        return error.get_exit_code() == 0 ? app.exit(error) : fail(error.what(), kBadUsage);
    } catch (const InputError& error) {
        return fail(error.what(), kBadUsage);
    } catch (const std::exception& error) {
        return fail(error.what(), kFailed);
    }
}
