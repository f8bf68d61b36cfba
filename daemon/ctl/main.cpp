#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "daemon/ctl/client.hpp"
#include "daemon/ctl/commands.hpp"
#include "daemon/ctl/when.hpp"
#include "protocol/core/clock_scale.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/message.hpp"

namespace {

using namespace a351;
using namespace a351::daemon::ctl;
void check(const Arguments& arguments) {
    const auto now = std::chrono::time_point_cast<Nanoseconds>(std::chrono::system_clock::now());
    for (const auto& [option, text] :
         {std::pair{"--at", &arguments.at}, {"--from", &arguments.from}, {"--to", &arguments.to}})
        if (!text->empty() && !parse_when(*text, now))
            throw InputError(
                fmt::format("{} = {}: not an instant; allowed: {}", option, *text, kAllowedWhen));
    if (!arguments.clock.empty() && !parse_clock_scale(arguments.clock, now))
        throw InputError("--clock = " + arguments.clock + ": allowed: scaled:FACTOR@UTC[,HOST]");
}

/// @throws InputError  there is no command, or arguments that it does not take.
void require_command(const CLI::App& app) {
    const auto chosen = app.get_subcommands();
    const auto extras = app.remaining();
    if (!chosen.empty() && extras.empty()) return;
    if (!chosen.empty()) {
        const std::string command = chosen.front()->get_name();
        throw InputError(fmt::format("{} is not an argument of {}; see a351ctl {} --help",
                                     extras.front(), command, command));
    }
    std::string commands;
    for (const CLI::App* one : app.get_subcommands([](const CLI::App*) { return true; }))
        commands += (commands.empty() ? "" : ", ") + one->get_name();
    throw InputError(fmt::format(
        "{}; allowed: {}",
        extras.empty() ? "no command is given" : extras.front() + " is not a command", commands));
}

}  // namespace

int main(int argc, char** argv) {
    text::write_in(text::language_of_environment());
    Arguments a;
    CLI::App app("Shows the state of the daemon a351d and controls occupations.", "a351ctl");
    app.set_version_flag("--version", std::string("a351ctl ") + A351_VERSION);
    app.add_option(
           "--url", a.urls,
           "Address of the daemon; several for start, stop and setup, at one instant, and for note")
        ->type_name("URL")
        ->envname("A351_URL")
        ->allow_extra_args(false)
        ->default_str(a.urls.front());
    app.add_option("--clock", a.clock,
                   "Simulated time, scaled:FACTOR@UTC[,HOST]; checked but without effect, because "
                   "the daemon gives all times")
        ->type_name("SCALE");
    app.add_option("--token", a.token,
                   "Token for changes over a network; better set A351_TOKEN, because others see "
                   "this option")
        ->type_name("TOKEN")
        ->envname("A351_TOKEN");
    app.fallthrough();

    const auto add_at = [&](CLI::App* command) {
        command
            ->add_option("--at", a.at,
                         "Instant in the recorded past: RFC 3339, local HH:MM[:SS] or -12min; "
                         "default: the last sample")
            ->type_name("WHEN");
    };
    const auto add_remark = [&](CLI::App* command) {
        command->add_option("--operator", a.operator_name, "Name of the operator")
            ->type_name("NAME");
        command->add_option("--note", a.note, "Remark")->type_name("WORDS");
    };
    const auto add_json = [&](CLI::App* command) {
        command->add_flag("--json", a.json, "Print the daemon's answer unchanged (JSON)");
    };
    const auto add_reason = [&](CLI::App* command) {
        command->add_option("--reason", a.reason, "Why the stay is changed")->type_name("WORDS");
        command->add_option("--operator", a.operator_name, "Name of the operator")
            ->type_name("NAME");
    };
    auto* status = app.add_subcommand("status",
                                      "Shows the status on one screen. Exit status: 0 good, 1 "
                                      "warning, 2 fault, 3 not running or bad usage.");
    add_json(status);
    auto* start = app.add_subcommand("start", "Starts an occupation at a benchmark.");
    start->add_option("SITE", a.site, "Benchmark, as in sites")->type_name("")->required();
    add_at(start);
    add_remark(start);
    start
        ->add_option("--set-ups", a.set_ups,
                     "Planned set-ups of this stay, three minutes each (2-100); 20 for a placement "
                     "test; default: as configured")
        ->type_name("N");
    auto* stop = app.add_subcommand("stop", "Stops the running occupation.");
    add_at(stop);
    add_remark(stop);
    auto* setup = app.add_subcommand(
        "setup", "Begins a further set-up: the box was lifted and set down again.");
    add_at(setup);
    constexpr const char* kStay = "Key of the stay, from list; default: the running or last one";
    auto* discard = app.add_subcommand("discard", "Discards a stay; its data are kept.");
    discard->add_option("STAY", a.stay, kStay)->type_name("");
    add_reason(discard);
    auto* restore = app.add_subcommand("restore", "Cancels the discard of a stay.");
    restore->add_option("STAY", a.stay, "Key of the stay, from list")->type_name("")->required();
    add_reason(restore);
    auto* not_moved = app.add_subcommand(
        "not-moved",
        "States that the box was not moved during a stay so far, in answer to the warning.");
    not_moved->add_option("STAY", a.stay, kStay)->type_name("");
    add_reason(not_moved);
    auto* resume = app.add_subcommand(
        "resume", "Continues the last stay, at most 10 min after it was stopped by mistake.");
    resume->add_option("STAY", a.stay, kStay)->type_name("");
    add_reason(resume);
    auto* rename = app.add_subcommand("rename", "Corrects the site of a stay.");
    rename
        ->add_option("[STAY] SITE", a.stay_and_site,
                     "Key of the stay, from list (default: the running or last one), and its "
                     "correct benchmark")
        ->type_name("")
        ->expected(1, 2)
        ->required();
    add_reason(rename);
    auto* retime = app.add_subcommand("retime", "Corrects start or end of a stay.");
    retime->add_option("STAY", a.stay, "Key of the stay, from list")->type_name("")->required();
    retime->add_option("--from", a.from, "New start: RFC 3339, local HH:MM[:SS] or -12min")
        ->type_name("WHEN");
    retime->add_option("--to", a.to, "New end, likewise")->type_name("WHEN");
    add_reason(retime);
    auto* note = app.add_subcommand("note", "Writes a remark to the event log.");
    note->add_option("WORDS", a.note, "Remark")->type_name("")->required();
    note->add_option("--stay", a.stay, "Key of the stay; default: the running one, if any")
        ->type_name("KEY");
    auto* target =
        app.add_subcommand("target", "Sets the standard error at which a reading is good enough.");
    target->add_option("MGAL", a.target_mgal, "Standard error, 0.01-1000 mGal")
        ->type_name("")
        ->required();
    add_json(
        app.add_subcommand("sites", "Lists the benchmarks, nearest to the last occupation first."));
    add_json(app.add_subcommand(
        "survey",
        "Shows the corrected gravity of each stay so far, and what is wrong with the day."));
    add_json(app.add_subcommand(
        "list", "Lists the finished stays with their keys, then the discarded ones."));
    auto* phone = app.add_subcommand(
        "phone", "Shows the address of the page, with its token, as a code for a telephone.");
    phone
        ->add_option("ADDRESS", a.address,
                     "Address of this computer, if it has several; default: the first")
        ->type_name("");
    auto* site = app.add_subcommand("site", "Changes the list of benchmarks.");
    site->require_subcommand(1);
    auto* site_add = site->add_subcommand("add", "Appends a benchmark to the list of the daemon.");
    site_add->add_option("NAME", a.site, "Name, not in the list yet")->type_name("")->required();
    site_add->add_option("--latitude", a.latitude_deg, "Latitude, degrees north")
        ->type_name("DEG")
        ->required();
    site_add->add_option("--longitude", a.longitude_deg, "Longitude, degrees east")
        ->type_name("DEG")
        ->required();
    site_add->add_option("--height", a.height_m, "Height above sea level, if known")
        ->type_name("M");
    site_add->add_option("--gravity", a.gravity_mgal, "Gravity, if known")->type_name("MGAL");
    app.allow_extras();  // Not inherited by the commands, because they are there already.

    const auto usage_status = [&] { return *status ? kNoDaemon : kUsage; };
    try {
        app.parse(argc, argv);
        require_command(app);
        check(a);
        const std::string command = app.get_subcommands().front()->get_name();
        if (command == "rename") {
            a.site = a.stay_and_site.back();
            if (a.stay_and_site.size() > 1) a.stay = a.stay_and_site.front();
        }
        const int result = run_command(command, a);
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
            throw std::runtime_error(text::tr("the output could not be written"));
        return result;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        complain(std::string(error.what()) + "; see a351ctl --help");
        return usage_status();
    } catch (const InputError& error) {
        complain(error.what());
        return usage_status();
    } catch (const NoDaemon& error) {
        complain(error.what());
        return kNoDaemon;
    } catch (const nlohmann::json::exception&) {
        complain(text::tr("the program at this address is not a351d; check --url"));
        return kNoDaemon;
    } catch (const std::exception& error) {
        complain(error.what());
        return *status ? kNoDaemon : kRefused;
    }
}
