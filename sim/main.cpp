#include <csignal>
#include <iostream>

#include "protocol/core/input_error.hpp"
#include "sim/command/commands.hpp"

namespace {

constexpr int kDone = 0, kFailed = 1, kBadUsage = 2;

volatile std::sig_atomic_t g_stop = 0;

void on_signal(int) { g_stop = 1; }

/// Catches SIGINT and SIGTERM; the returned predicate is true once either has arrived.
std::function<bool()> until_stopped() {
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
    using namespace a351::sim;
    CLI::App app{"Emulates an M-A351 accelerometer and simulates survey days.", "a351-sim"};
    app.set_version_flag("--version", "a351-sim " A351_VERSION);
    app.require_subcommand(1);
    command::add_device_command(app, until_stopped);
    command::add_replay_command(app, until_stopped);
    command::add_survey_command(app);
    command::add_plan_command(app);
    try {
        app.parse(argc, argv);
        return kDone;
    } catch (const CLI::ParseError& error) {
        return error.get_exit_code() == 0 ? app.exit(error) : fail(error.what(), kBadUsage);
    } catch (const InputError& error) {
        return fail(error.what(), kBadUsage);
    } catch (const std::exception& error) {
        return fail(error.what(), kFailed);
    }
}
