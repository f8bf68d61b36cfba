#include "daemon/ctl/commands.hpp"

#include <fmt/core.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "daemon/ctl/client.hpp"
#include "daemon/ctl/meant_stay.hpp"
#include "daemon/ctl/screen.hpp"
#include "daemon/ctl/survey_text.hpp"
#include "daemon/ctl/when.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/sites.hpp"

namespace a351::daemon::ctl {

void complain(const std::string& text) {
    std::fprintf(stderr, "a351ctl: %s\n", printable(text).c_str());
}

namespace {

using nlohmann::json;

constexpr int kRefreshMs = 1000;

volatile std::sig_atomic_t g_stop = 0;

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

json parsed(const Reply& reply) {
    auto body = json::parse(reply.body, nullptr, false);
    if (!body.is_object()) throw NoDaemon("the program at this address is not a351d; check --url");
    return body;
}

/// Returns the body of a good answer; otherwise prints the error and returns std::nullopt.
/// @param prefix  begins the printed error.
std::optional<json> accepted(const Reply& reply, const std::string& prefix = {}) {
    auto body = parsed(reply);
    if (reply.status == 200) return body;
    const auto error = body.find("error");
    complain(prefix + (error != body.end() && error->is_string()
                           ? error->get<std::string>()
                           : fmt::format("the daemon answered with status {}", reply.status)));
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
            winsize size{};
            if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0)
                screen = fitted(screen, size.ws_col, size.ws_row);
            std::string cleared = "\x1b[H";
            for (const char c : screen) cleared += c == '\n' ? "\x1b[K\n" : std::string(1, c);
            print(cleared + "\x1b[K\x1b[J");
        } else {
            print(screen + "\n");
        }
        std::fflush(stdout);
        if (!g_stop) poll(nullptr, 0, kRefreshMs);  // A signal ends the wait, unlike sleep_for.
    }
    return kDone;
}

/// Sends a change.  @param prefix  begins the printed answer.
int change(const Client& client, const Arguments& arguments, const std::string& path,
           const json& body, const std::string& prefix = {}) {
    std::string token = arguments.token;
    if (token.empty()) {
        const auto answer = accepted(client.get("/api/token"));
        if (!answer) return kRefused;
        token = answer->value("token", "");
    }
    // Arguments may be invalid UTF-8; invalid parts become U+FFFD, which the daemon does not know.
    const std::string text = body.dump(-1, ' ', false, json::error_handler_t::replace);
    const auto answer = accepted(client.post(path, text, token), prefix);
    if (!answer) return kRefused;
    print(prefix + printable(answer->value("message", "done")) + "\n");
    return kDone;
}

/// Makes the body of a request from the texts that were given.
json order(const Client& client, const Arguments& arguments) {
    json body = json::object();
    const auto add = [&](const char* key, const std::string& text) {
        if (!text.empty()) body[key] = text;
    };
    add("key", arguments.stay);
    add("site", arguments.site);
    add("operator", arguments.operator_name);
    add("note", arguments.note);
    add("reason", arguments.reason);
    // Only the daemon knows its time: the host's differs if the daemon runs on simulated time.
    std::optional<UtcTime> now;
    for (const auto& [key, text] :
         {std::pair{"at", &arguments.at}, {"from", &arguments.from}, {"to", &arguments.to}}) {
        if (text->empty()) continue;
        if (!now) now = parse_rfc3339(parsed(client.get("/api/status")).value("now", ""));
        const auto instant = now ? parse_when(*text, *now) : parse_rfc3339(*text);
        body[key] = instant ? to_rfc3339(*instant, 9) : *text;
    }
    return body;
}

/// Longest difference between the last samples of several daemons, s.  Reason: a box that records
/// is a second late at most; the instant of one that does not would lie in the drive before.
constexpr double kMostApart_s = 10.0;

/// Sends start, stop or setup to several daemons, at one instant that all of them have recorded.
/// Without a given instant nothing is sent if a daemon gets no samples.
int change_all(const Arguments& arguments, const std::string& command) {
    std::vector<Client> clients;
    for (const std::string& url : arguments.urls) clients.emplace_back(parse_url(url));
    std::vector<std::pair<UtcTime, std::string>> last;  // Last sample and address of each.
    for (std::size_t i = 0; i < clients.size(); ++i) {
        const auto status = parsed(clients[i].get("/api/status"));
        const json sample = status.value("sample", json());
        const auto utc = parse_rfc3339(sample.is_object() ? sample.value("utc", "") : "");
        if (utc) last.emplace_back(*utc, printable(arguments.urls[i]));
    }
    json body = order(clients.front(), arguments);
    if (!body.contains("at") && !last.empty()) {
        const auto [first, newest] = std::ranges::minmax_element(last);
        const double apart_s = seconds_between(first->first, newest->first);
        if (apart_s > kMostApart_s) {
            complain(fmt::format(
                "{}: its last sample is {:.0f} s older than that of {}; nothing was changed; "
                "allowed: {:.0f} s, or an instant by --at",
                first->second, apart_s, newest->second, kMostApart_s));
            return kRefused;
        }
        body["at"] = to_rfc3339(first->first, 9);
    }
    int worst = kDone;
    for (std::size_t i = 0; i < clients.size(); ++i)
        worst = std::max(worst, change(clients[i], arguments, "/api/occupation/" + command, body,
                                       printable(arguments.urls[i]) + ": "));
    return worst;
}

int add_site(const Client& client, const Arguments& arguments) {
    if (const auto trouble = text::trouble_with_site_name(arguments.site); !trouble.empty()) {
        complain(trouble);
        return kRefused;
    }
    json body{{"site", arguments.site},
              {"latitude_deg", arguments.latitude_deg},
              {"longitude_deg", arguments.longitude_deg}};
    if (arguments.height_m) body["altitude_m"] = *arguments.height_m;
    if (arguments.gravity_mgal) body["gravity_mgal"] = *arguments.gravity_mgal;
    return change(client, arguments, "/api/sites", body);
}

/// Changes the stay that was named; without a name the running or last one, which is printed first.
int change_stay(const Client& client, Arguments arguments, const std::string& command) {
    json body = order(client, arguments);
    if (arguments.stay.empty()) {
        const auto status = accepted(client.get("/api/status"));
        const auto list = accepted(client.get("/api/occupations"));
        if (!status || !list) return kRefused;
        const auto stay = meant_stay(*status, *list);
        if (!stay) {
            complain("there is no stay to " + command);
            return kRefused;
        }
        print(fmt::format("{}: {}\n", command, printable(stay->text)));
        std::fflush(stdout);
        body["key"] = stay->key;
        // The daemon refuses if the stay got another site in the meantime.
        if (command != "rename") body["site"] = stay->site;
    }
    return change(client, arguments, "/api/occupation/" + command, body);
}

int show(const Client& client, const Arguments& arguments, const std::string& path,
         std::string (*table)(const json&)) {
    const auto reply = client.get(path);
    const auto answer = accepted(reply);
    if (!answer) return kRefused;
    print(arguments.json ? reply.body : table(*answer));
    return kDone;
}

}  // namespace

int run_command(const std::string& command, const Arguments& arguments) {
    const bool is_start = command == "start" || command == "stop" || command == "setup";
    if (arguments.urls.size() > 1 && !is_start)
        throw InputError("--url: given more than once; allowed for start, stop and setup only");
    if (arguments.urls.size() > 1) return change_all(arguments, command);
    const Client client(parse_url(arguments.urls.front()));
    if (command == "site") return add_site(client, arguments);
    if (command == "status") return show_status(client, arguments);
    if (command == "watch") return watch(client);
    if (command == "sites") return show(client, arguments, "/api/sites", site_table);
    if (command == "survey") return show(client, arguments, "/api/survey", survey_text);
    if (command == "list") return show(client, arguments, "/api/occupations", occupation_table);
    if (command == "target")
        return change(client, arguments, "/api/target",
                      json{{"target_mgal", arguments.target_mgal}});
    if (command == "note") return change(client, arguments, "/api/note", order(client, arguments));
    if (is_start)
        return change(client, arguments, "/api/occupation/" + command, order(client, arguments));
    return change_stay(client, arguments, command == "not-moved" ? "not_moved" : command);
}

}  // namespace a351::daemon::ctl
