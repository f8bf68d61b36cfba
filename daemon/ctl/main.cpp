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

constexpr const char* kStay = "Key of the stay, from list; default: the running or last one";

void add_at(CLI::App* command, Arguments& a) {
    command
        ->add_option(
            "--at", a.at,
            "Instant in the recorded past: RFC 3339, local HH:MM[:SS], HH:MMZ in UTC or -12min; "
            "default: the last sample")
        ->type_name("WHEN");
}

void add_face(CLI::App* command, Arguments& a) {
    command
        ->add_option("--face", a.face,
                     "Face of the set-up: + if the vertical axis points up, - if the box is turned "
                     "over; default: as the data say")
        ->type_name("+|-")
        ->check(CLI::IsMember({"+", "-"}).description(""));
}

void add_operator(CLI::App* command, Arguments& a) {
    command->add_option("--operator", a.operator_name, "Name of the operator")->type_name("NAME");
}

void add_remark(CLI::App* command, Arguments& a) {
    add_operator(command, a);
    command->add_option("--note", a.note, "Remark")->type_name("WORDS");
}

void add_json(CLI::App* command, Arguments& a) {
    command->add_flag("--json", a.json, "Print the daemon's answer unchanged (JSON)");
}

void add_reason(CLI::App* command, Arguments& a) {
    command->add_option("--reason", a.reason, "Why the stay is changed")->type_name("WORDS");
    add_operator(command, a);
}

/// Adds a change of the running or last stay, or of the one that is named.
void add_change(CLI::App& app, Arguments& a, const char* name, const char* what) {
    auto* command = app.add_subcommand(name, what);
    command->add_option("STAY", a.stay, kStay)->type_name("");
    add_reason(command, a);
}

/// Adds the stay of a command that has no default for it.
void add_named_stay(CLI::App* command, Arguments& a) {
    command->add_option("STAY", a.stay, "Key of the stay, from list")->type_name("")->required();
}

void add_global_options(CLI::App& app, Arguments& a) {
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
}

void add_status(CLI::App& app, Arguments& a) {
    add_json(app.add_subcommand("status",
                                "Shows the status on one screen. Exit status: 0 good, 1 warning, "
                                "2 fault, 3 not running or bad usage."),
             a);
}

void add_start(CLI::App& app, Arguments& a) {
    auto* start = app.add_subcommand("start", "Starts an occupation at a benchmark.");
    start->add_option("SITE", a.site, "Benchmark, as in sites")->type_name("")->required();
    add_at(start, a);
    add_remark(start, a);
    start
        ->add_option("--set-ups", a.set_ups,
                     "Planned set-ups of this stay, three minutes each (2-100); 20 for a placement "
                     "test; default: as configured")
        ->type_name("N");
    add_face(start, a);
}

void add_stop(CLI::App& app, Arguments& a) {
    auto* stop = app.add_subcommand("stop", "Stops the running occupation.");
    add_at(stop, a);
    add_remark(stop, a);
}

void add_setup(CLI::App& app, Arguments& a) {
    auto* setup = app.add_subcommand(
        "setup", "Begins a further set-up: the box was lifted and set down again.");
    add_at(setup, a);
    add_face(setup, a);
}

void add_discard(CLI::App& app, Arguments& a) {
    add_change(app, a, "discard", "Discards a stay; its data are kept.");
}

void add_restore(CLI::App& app, Arguments& a) {
    auto* restore = app.add_subcommand("restore", "Cancels the discard of a stay.");
    add_named_stay(restore, a);
    add_reason(restore, a);
}

void add_not_moved(CLI::App& app, Arguments& a) {
    add_change(app, a, "not-moved",
               "Confirms that the box was not moved during a stay so far (answers the warning).");
}

void add_checked(CLI::App& app, Arguments&) {
    app.add_subcommand("checked",
                       "Confirms that you have looked at what LOOK shows; the notes keep it.");
}

void add_resume(CLI::App& app, Arguments& a) {
    add_change(app, a, "resume",
               "Continues the last stay, at most 10 min after it was stopped by mistake.");
}

void add_rename(CLI::App& app, Arguments& a) {
    auto* rename = app.add_subcommand("rename", "Corrects the site of a stay: rename [STAY] SITE.");
    rename
        ->add_option("SITE", a.stay_and_site,
                     "Key of the stay, from list (default: the running or last one), and the "
                     "correct benchmark")
        ->type_name("")
        ->expected(1, 2)
        ->required();
    add_reason(rename, a);
}

void add_retime(CLI::App& app, Arguments& a) {
    auto* retime = app.add_subcommand("retime", "Corrects start or end of a stay.");
    add_named_stay(retime, a);
    retime
        ->add_option("--from", a.from,
                     "New start: RFC 3339, local HH:MM[:SS], HH:MMZ in UTC or -12min")
        ->type_name("WHEN");
    retime->add_option("--to", a.to, "New end, likewise")->type_name("WHEN");
    add_reason(retime, a);
}

void add_note(CLI::App& app, Arguments& a) {
    auto* note = app.add_subcommand("note", "Writes a remark to the event log.");
    note->add_option("WORDS", a.note, "Remark")->type_name("")->required();
    note->add_option("--stay", a.stay, "Key of the stay; default: the running one, if any")
        ->type_name("KEY");
}

void add_sites(CLI::App& app, Arguments& a) {
    add_json(
        app.add_subcommand("sites", "Lists the benchmarks, nearest to the last occupation first."),
        a);
}

void add_survey(CLI::App& app, Arguments& a) {
    add_json(app.add_subcommand("survey",
                                "Shows the corrected gravity of each stay so far, and the "
                                "problems of the day."),
             a);
}

void add_list(CLI::App& app, Arguments& a) {
    add_json(app.add_subcommand(
                 "list", "Lists the finished stays with their keys, then the discarded ones."),
             a);
}

void add_phone(CLI::App& app, Arguments& a) {
    app.add_subcommand("phone",
                       "Shows the address of the page, with its token, as a code for a telephone.")
        ->add_option("ADDRESS", a.address,
                     "Address of this computer, if it has several; default: the first")
        ->type_name("");
}

void add_bundle(CLI::App& app, Arguments& a) {
    app.add_subcommand(
           "bundle", "Saves the survey day as one file, to take it home; the recording continues.")
        ->add_option("--out", a.out,
                     "File to write (tar), or a folder, in which it gets the name of the day")
        ->type_name("FILE")
        ->required();
}

void add_site(CLI::App& app, Arguments& a) {
    auto* site = app.add_subcommand("site", "Changes the list of benchmarks.");
    site->require_subcommand(1);
    auto* add = site->add_subcommand("add", "Appends a benchmark to the list of the daemon.");
    add->add_option("NAME", a.site, "Name, not in the list yet")->type_name("")->required();
    add->add_option("--latitude", a.latitude_deg, "Latitude, degrees north")
        ->type_name("DEG")
        ->required();
    add->add_option("--longitude", a.longitude_deg, "Longitude, degrees east")
        ->type_name("DEG")
        ->required();
    add->add_option("--height", a.height_m, "Height above sea level, if known")->type_name("M");
    add->add_option("--gravity", a.gravity_mgal, "Gravity, if known")->type_name("MGAL");
}

/// Parses the command line and carries out its command.  @return the exit status
int run(CLI::App& app, Arguments& a, int argc, char** argv) {
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
}

}  // namespace

int main(int argc, char** argv) {
    text::write_in(text::language_of_environment());
    Arguments a;
    CLI::App app("Shows the state of the daemon a351d and controls occupations.", "a351ctl");
    add_global_options(app, a);
    for (const auto add : {add_status, add_start, add_stop, add_setup, add_discard, add_restore,
                           add_not_moved, add_checked, add_resume, add_rename, add_retime, add_note,
                           add_sites, add_survey, add_list, add_phone, add_bundle, add_site})
        add(app, a);
    app.allow_extras();  // Not inherited by the commands, because they are there already.

    const auto usage_status = [&] { return app.got_subcommand("status") ? kNoDaemon : kUsage; };
    try {
        return run(app, a, argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        if (error.get_name() == "RequiredError" && std::string(error.what()).starts_with("STAY")) {
            complain(text::tr("the key of the stay is missing; a351ctl list shows it"));
            return kUsage;
        }
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
        return app.got_subcommand("status") ? kNoDaemon : kRefused;
    }
}
