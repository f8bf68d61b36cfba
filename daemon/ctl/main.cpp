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
using namespace a351::daemon;
using nlohmann::json;

constexpr int kDone = 0;
constexpr int kRefused = 1;
constexpr int kUsage = 2;
constexpr int kNoDaemon = 3;  // For `status` also: not asked correctly, as monitoring plugins do.
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
    if (!body.is_object()) throw NoDaemon("what answers there is no a351d");
    return body;
}

/// The body of a good answer; std::nullopt after the complaint about another one.
std::optional<json> accepted(const Reply& reply) {
    auto body = parsed(reply);
    if (reply.status == 200) return body;
    const auto error = body.find("error");
    complain(error != body.end() && error->is_string()
                 ? error->get<std::string>()
                 : "answered with status " + std::to_string(reply.status));
    return std::nullopt;
}

int show_status(const Client& client, const Arguments& arguments) {
    const auto reply = client.get("/api/status");
    const auto status = accepted(reply);
    if (!status) return kNoDaemon;
    print(arguments.json ? reply.body : status_screen(*status, isatty(STDOUT_FILENO) != 0));
    return plugin_status(*status);
}

/// On a terminal each screen overwrites the last one.
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

/// The given ones of site, operator, note and at.
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
        throw InputError("--at = " + arguments.at +
                         ": not an instant; allowed: RFC 3339 such as 2026-01-31T09:30:00Z");
    }
    const auto now = std::chrono::time_point_cast<Nanoseconds>(std::chrono::system_clock::now());
    if (!arguments.clock.empty() && !parse_clock_scale(arguments.clock, now)) {
        throw InputError("--clock = " + arguments.clock + ": allowed: scaled:FACTOR@UTC[,HOST]");
    }
}

}  // namespace

int main(int argc, char** argv) {
    Arguments a;
    CLI::App app("Operator's tool of the daemon a351d", "a351ctl");
    app.set_version_flag("--version", std::string("a351ctl ") + A351_VERSION);
    app.add_option("--url", a.url, "Address of the daemon")->capture_default_str();
    app.add_option("--clock", a.clock,
                   "Simulated time, as the other programs take it; instants are asked of the "
                   "daemon, so it changes nothing here");
    app.add_option("--token", a.token,
                   "Token of a daemon that is reached over a network; better by the environment")
        ->envname("A351_TOKEN");
    app.require_subcommand(1);
    app.fallthrough();

    const auto add_at = [&](CLI::App* command) {
        command->add_option("--at", a.at, "Instant in the recorded past, RFC 3339");
    };
    const auto add_remark = [&](CLI::App* command) {
        command->add_option("--operator", a.operator_name, "Name of the operator");
        command->add_option("--note", a.note, "Remark");
    };
    auto* status = app.add_subcommand("status",
                                      "One screen: exit status 0 good, 1 warning, 2 "
                                      "fault, 3 not running or not asked correctly");
    status->add_flag("--json", a.json, "The answer of the daemon as it is");
    auto* watching = app.add_subcommand("watch", "The same, refreshed until interrupted");
    auto* start = app.add_subcommand("start", "Start an occupation");
    start->add_option("SITE", a.site, "Benchmark")->required();
    add_at(start);
    add_remark(start);
    auto* stop = app.add_subcommand("stop", "Stop the running occupation");
    add_at(stop);
    add_remark(stop);
    auto* setup = app.add_subcommand("setup", "The sensor was set down anew at the same site");
    add_at(setup);
    auto* discard =
        app.add_subcommand("discard", "Discard the running or else the last occupation");
    auto* rename = app.add_subcommand("rename", "Give the running or else the last one its site");
    rename->add_option("NAME", a.site, "Benchmark")->required();
    auto* note = app.add_subcommand("note", "Write a remark to the event log");
    note->add_option("TEXT", a.note, "Remark")->required();
    auto* target = app.add_subcommand("target", "Set what standard error is good enough");
    target->add_option("MGAL", a.target_mgal, "mGal, 0.01 to 1000")->required();
    auto* sites = app.add_subcommand("sites", "List the benchmarks, nearest first");
    auto* list = app.add_subcommand("list", "List the finished occupations");

    const auto usage_status = [&] { return *status ? kNoDaemon : kUsage; };
    try {
        app.parse(argc, argv);
        check(a);
        const Client client(parse_url(a.url));
        if (*status) return show_status(client, a);
        if (*watching) return watch(client);
        if (*start) return change(client, a, "/api/occupation/start", order(a));
        if (*stop) return change(client, a, "/api/occupation/stop", order(a));
        if (*setup) return change(client, a, "/api/occupation/setup", order(a));
        if (*discard) return change(client, a, "/api/occupation/discard", order(a));
        if (*rename) return change(client, a, "/api/occupation/rename", order(a));
        if (*note) return change(client, a, "/api/note", order(a));
        if (*target) return change(client, a, "/api/target", json{{"target_mgal", a.target_mgal}});
        if (*sites) return show(client, "/api/sites", site_table);
        if (*list) return show(client, "/api/occupations", occupation_table);
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
    return kUsage;
}
