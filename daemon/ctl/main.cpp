#include <fmt/core.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "daemon/ctl/client.hpp"
#include "daemon/ctl/screen.hpp"
#include "protocol/core/clock_scale.hpp"
#include "protocol/core/input_error.hpp"

namespace {

using namespace a351;
using namespace a351::daemon::ctl;
using nlohmann::json;

constexpr int kDone = 0;
constexpr int kRefused = 1;
constexpr int kUsage = 2;
constexpr int kNoDaemon = 3;  // Also bad usage of `status`, as for monitoring plugins.
constexpr int kRefreshMs = 1000;

volatile std::sig_atomic_t g_stop = 0;

struct Arguments {
    std::string url = "http://127.0.0.1:8351";
    std::string clock;
    std::string token;
    bool json = false;
    std::string site;
    std::string at;
    std::string operator_name;
    std::string note;
    double target_mgal = 0.0;
};

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

void complain(const std::string& text) {
    std::fprintf(stderr, "a351ctl: %s\n", printable(text).c_str());
}

json parsed(const Reply& reply) {
    auto body = json::parse(reply.body, nullptr, false);
    if (!body.is_object()) throw NoDaemon("the program at this address is not a351d; check --url");
    return body;
}

/// Returns the body of a good answer; otherwise prints the error and returns std::nullopt.
std::optional<json> accepted(const Reply& reply) {
    auto body = parsed(reply);
    if (reply.status == 200) return body;
    const auto error = body.find("error");
    complain(error != body.end() && error->is_string()
                 ? error->get<std::string>()
                 : fmt::format("the daemon answered with status {}", reply.status));
    return std::nullopt;
}

int show_status(const Client& client, const Arguments& arguments) {
    const auto reply = client.get("/api/status");
    const auto status = accepted(reply);
    if (!status) return kNoDaemon;
    print(arguments.json ? reply.body : status_screen(*status, isatty(STDOUT_FILENO) != 0));
    return plugin_status(*status);
}

/// Shows the screen once a second; on a terminal each screen overwrites the last one.
int watch(const Client& client) {
    struct sigaction action {};
    action.sa_handler = [](int) { g_stop = 1; };
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);

    const bool is_terminal = isatty(STDOUT_FILENO) != 0;
    if (is_terminal) print("\x1b[2J");
    while (!g_stop) {
        std::string screen;
        try {
            const auto reply = client.get("/api/status");
            screen = reply.status == 200 ? status_screen(parsed(reply), is_terminal)
                                         : printable(reply.body);
        } catch (const NoDaemon& error) {
            screen = std::string(error.what()) + "\n";
        }
        if (is_terminal) {
            std::string cleared = "\x1b[H";
            for (const char c : screen) cleared += c == '\n' ? "\x1b[K\n" : std::string(1, c);
            print(cleared + "\x1b[J");
        } else {
            print(screen + "\n");
        }
        std::fflush(stdout);
        if (!g_stop) poll(nullptr, 0, kRefreshMs);  // A signal ends the wait, unlike sleep_for.
    }
    return kDone;
}

int change(const Client& client, const Arguments& arguments, const std::string& path,
           const json& body) {
    std::string token = arguments.token;
    if (token.empty()) {
        const auto answer = accepted(client.get("/api/token"));
        if (!answer) return kRefused;
        token = answer->value("token", "");
    }
    const auto answer = accepted(client.post(path, body.dump(), token));
    if (!answer) return kRefused;
    print(printable(answer->value("message", "done")) + "\n");
    return kDone;
}

/// Makes the body of a request from those of site, operator, note and at that were given.
json order(const Arguments& arguments) {
    json body = json::object();
    const auto add = [&](const char* key, const std::string& text) {
        if (!text.empty()) body[key] = text;
    };
    add("site", arguments.site);
    add("operator", arguments.operator_name);
    add("note", arguments.note);
    add("at", arguments.at);
    return body;
}

int show(const Client& client, const std::string& path, std::string (*table)(const json&)) {
    const auto answer = accepted(client.get(path));
    if (!answer) return kRefused;
    print(table(*answer));
    return kDone;
}

void check(const Arguments& arguments) {
    if (!arguments.at.empty() && !parse_rfc3339(arguments.at)) {
        throw InputError(
            fmt::format("--at = {}: not an instant; allowed: RFC 3339 such as 2026-01-31T09:30:00Z",
                        arguments.at));
    }
    const auto now = std::chrono::time_point_cast<Nanoseconds>(std::chrono::system_clock::now());
    if (!arguments.clock.empty() && !parse_clock_scale(arguments.clock, now))
        throw InputError("--clock = " + arguments.clock + ": allowed: scaled:FACTOR@UTC[,HOST]");
}

}  // namespace

int main(int argc, char** argv) {
    Arguments a;
    CLI::App app("Shows the state of the daemon a351d and controls occupations", "a351ctl");
    app.set_version_flag("--version", std::string("a351ctl ") + A351_VERSION);
    app.add_option("--url", a.url, "Address of the daemon")
        ->type_name("URL")
        ->capture_default_str();
    app.add_option("--clock", a.clock,
                   "Simulated time; checked but has no effect here, because the daemon gives "
                   "all times")
        ->type_name("SCALE");
    app.add_option(
           "--token", a.token,
           "Token of a daemon that is reached over a network; preferably set A351_TOKEN instead")
        ->type_name("TOKEN")
        ->envname("A351_TOKEN");
    app.require_subcommand(1);
    app.fallthrough();

    const auto add_at = [&](CLI::App* command) {
        command
            ->add_option("--at", a.at,
                         "Time in the recorded past (RFC 3339); default: the last sample")
            ->type_name("UTC");
    };
    const auto add_remark = [&](CLI::App* command) {
        command->add_option("--operator", a.operator_name, "Name of the operator")
            ->type_name("NAME");
        command->add_option("--note", a.note, "Remark")->type_name("WORDS");
    };
    auto* status = app.add_subcommand("status",
                                      "Show the status on one screen; exit status 0 good, 1 "
                                      "warning, 2 fault, 3 not running or bad usage");
    status->add_flag("--json", a.json, "Print the daemon's answer unchanged (JSON)");
    app.add_subcommand("watch", "Show the status every second until interrupted");
    auto* start = app.add_subcommand("start", "Start an occupation at a benchmark");
    start->add_option("SITE", a.site, "Benchmark")->type_name("")->required();
    add_at(start);
    add_remark(start);
    auto* stop = app.add_subcommand("stop", "Stop the running occupation");
    add_at(stop);
    add_remark(stop);
    auto* setup = app.add_subcommand(
        "setup", "Begin a further set-up: the sensor was lifted and set down again");
    add_at(setup);
    app.add_subcommand("discard", "Discard the running occupation, or else the last one");
    auto* rename = app.add_subcommand(
        "rename", "Correct the site of the running occupation, or else of the last");
    rename->add_option("NAME", a.site, "Benchmark")->type_name("")->required();
    auto* note = app.add_subcommand("note", "Write a remark to the event log");
    note->add_option("WORDS", a.note, "Remark")->type_name("")->required();
    auto* target =
        app.add_subcommand("target", "Set the standard error at which a reading is good enough");
    target->add_option("MGAL", a.target_mgal, "Standard error, 0.01-1000 mGal")
        ->type_name("")
        ->required();
    app.add_subcommand("sites", "List the benchmarks, nearest to the last occupation first");
    app.add_subcommand("list", "List the finished occupations");

    const auto usage_status = [&] { return *status ? kNoDaemon : kUsage; };
    try {
        app.parse(argc, argv);
        check(a);
        const Client client(parse_url(a.url));
        const std::string command = app.get_subcommands().front()->get_name();
        if (command == "status") return show_status(client, a);
        if (command == "watch") return watch(client);
        if (command == "sites") return show(client, "/api/sites", site_table);
        if (command == "list") return show(client, "/api/occupations", occupation_table);
        if (command == "note") return change(client, a, "/api/note", order(a));
        if (command == "target")
            return change(client, a, "/api/target", json{{"target_mgal", a.target_mgal}});
        return change(client, a, "/api/occupation/" + command, order(a));
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
    } catch (const std::exception& error) {
        complain(error.what());
        return *status ? kNoDaemon : kRefused;
    }
}
