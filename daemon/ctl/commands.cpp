#include "daemon/ctl/commands.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/ctl/client.hpp"
#include "daemon/ctl/meant_stay.hpp"
#include "daemon/ctl/phone.hpp"
#include "daemon/ctl/requests.hpp"
#include "daemon/ctl/screen.hpp"
#include "daemon/ctl/survey_text.hpp"
#include "daemon/ctl/take_home.hpp"
#include "daemon/ctl/when.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/message.hpp"
#include "protocol/text/sites.hpp"

namespace a351::daemon::ctl {

void complain(const std::string& text) {
    std::fprintf(stderr, "a351ctl: %s\n", printable(text).c_str());
}

namespace {

using nlohmann::json;

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

/// Returns true if standard output is a terminal that may be coloured: not with TERM=dumb, and not if
/// the environment variable NO_COLOR (no-color.org) is set and not empty.
bool wants_colour() {
    const char* const kind = std::getenv("TERM");
    const char* const no_colour = std::getenv("NO_COLOR");
    return isatty(STDOUT_FILENO) != 0 && (kind == nullptr || std::string_view(kind) != "dumb") &&
           (no_colour == nullptr || *no_colour == '\0');
}

/// Returns the body of a good answer; otherwise prints the error and returns std::nullopt.
/// @param prefix  begins the printed error.
std::optional<json> accepted(Answer answer, const std::string& prefix = {}) {
    if (answer.error.empty()) return std::move(answer.body);
    complain(prefix + answer.error);
    return std::nullopt;
}

int show_status(const Client& client, const Arguments& arguments) {
    const auto reply = client.get(arguments.json ? "/api/status" : "/api/rows");
    const auto answer = accepted(answer_of(reply));
    if (!answer) return kNoDaemon;
    print(arguments.json ? reply.body : status_screen(*answer, wants_colour()));
    return plugin_status(*answer);
}

/// Sends a change.  @param prefix  begins the printed answer.
int change(const Client& client, const Arguments& arguments, const std::string& path,
           const json& body, const std::string& prefix = {}) {
    const Answer answer = send_change(client, arguments.token, path, body);
    if (!accepted(answer, prefix)) return kRefused;
    print(prefix + message_of(answer) + "\n");
    return kDone;
}

/// Returns the path of start, stop, setup or note.
std::string path_of(const std::string& command) {
    return command == "note" ? "/api/note" : "/api/occupation/" + command;
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
    add("face", arguments.face);
    if (arguments.set_ups) body["set_ups"] = std::to_string(*arguments.set_ups);
    // Only the daemon knows its time: the host's differs if the daemon runs on simulated time.
    std::optional<UtcTime> now;
    for (const auto& [key, text] :
         {std::pair{"at", &arguments.at}, {"from", &arguments.from}, {"to", &arguments.to}}) {
        if (text->empty()) continue;
        if (!now) now = parse_rfc3339(answer_of(client.get("/api/status")).body.value("now", ""));
        const auto instant = now ? parse_when(*text, *now) : parse_rfc3339(*text);
        body[key] = instant ? to_rfc3339(*instant, 9) : *text;
    }
    return body;
}

/// Longest difference between the last samples of several daemons, s.  Reason: a box that records
/// is a second late at most; the instant of one that does not would lie in the drive before.
constexpr double kMostApart_s = 10.0;

/// One of several daemons that get the same order.
struct Box {
    Client client;
    std::string name;
    std::optional<UtcTime> last_sample = {};
    bool is_recording = false;  ///< Its last sample is at most kMostApart_s old by its own clock.
    bool is_there = false;
    bool is_left_out = false;
};

/// Asks for the last sample.  @throws NoDaemon
void ask(Box& box) {
    const Answer answer = answer_of(box.client.get("/api/status"));
    box.is_there = true;
    const auto sample = answer.body.find("sample");
    if (sample == answer.body.end() || !sample->is_object()) return;
    const auto utc = sample->find("utc"), age_s = sample->find("age_s");
    if (utc == sample->end() || !utc->is_string()) return;
    box.last_sample = parse_rfc3339(utc->get<std::string>());
    box.is_recording =
        age_s != sample->end() && age_s->is_number() && age_s->get<double>() <= kMostApart_s;
}

/// Returns the newest instant that most boxes have recorded, std::nullopt without data.  A box whose
/// last sample is far from the median's, as by a wrong clock, is named and gets no order.
std::optional<UtcTime> common_instant(std::vector<Box>& boxes) {
    const bool is_any_recording = std::ranges::any_of(boxes, &Box::is_recording);
    std::vector<UtcTime> last;
    for (const Box& box : boxes)
        if (box.last_sample && box.is_recording == is_any_recording)
            last.push_back(*box.last_sample);
    if (last.empty()) return std::nullopt;
    std::ranges::sort(last);
    const UtcTime median = last[(last.size() - 1) / 2];
    UtcTime common = median;
    for (Box& box : boxes) {
        if (!box.last_sample) continue;
        const double ahead_s = seconds_between(median, *box.last_sample);
        if (std::abs(ahead_s) <= kMostApart_s) {
            common = std::min(common, *box.last_sample);
            continue;
        }
        box.is_left_out = true;
        const std::string apart = fmt::format("{:.0f}", std::abs(ahead_s));
        complain(
            box.name +
            (ahead_s > 0
                 ? text::tr(
                       "left out: its last sample is {} s ahead of the others; check its clock, "
                       "then order it by itself",
                       apart)
                 : text::tr(
                       "left out: its last sample is {} s behind the others; check its cable and "
                       "clock, then order it by itself",
                       apart)));
    }
    return common;
}

/// Sends start, stop, setup or note to several daemons, the first three at one instant that most of
/// them have recorded.  A daemon that does not answer or refuses does not hinder the others.
int change_all(const Arguments& arguments, const std::string& command) {
    std::vector<Box> boxes;
    for (const std::string& url : arguments.urls)
        boxes.push_back({Client(parse_url(url)), printable(url) + ": "});
    std::optional<json> body;
    for (Box& box : boxes) {
        try {
            ask(box);
            if (!body) body = order(box.client, arguments);
        } catch (const NoDaemon& error) {
            box.is_there = false;
            complain(box.name + error.what());
        }
    }
    if (!body) return kNoDaemon;
    if (command != "note" && !body->contains("at"))
        if (const auto common = common_instant(boxes)) (*body)["at"] = to_rfc3339(*common, 9);
    std::ptrdiff_t done = 0;
    for (const Box& box : boxes) {
        if (!box.is_there || box.is_left_out) continue;
        try {
            if (change(box.client, arguments, path_of(command), *body, box.name) == kDone) ++done;
        } catch (const NoDaemon& error) {
            complain(box.name + error.what());
        }
    }
    const auto left_out = std::ranges::count(boxes, true, &Box::is_left_out);
    const auto failed = std::ssize(boxes) - left_out - done;
    if (done > 0 && failed > 0 && body->contains("at"))
        complain(text::tr("repeat it with --at {}; boxes that did it before change nothing",
                          body->at("at").get<std::string>()));
    return failed + left_out > 0 ? kRefused : kDone;
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
        const auto status = accepted(answer_of(client.get("/api/status")));
        const auto list = accepted(answer_of(client.get("/api/occupations")));
        if (!status || !list) return kRefused;
        const auto stay = meant_stay(*status, *list);
        if (!stay) {
            complain(text::tr("there is no stay for this command"));
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

void print_code(const std::string& url) { print(qr_text(url, wants_colour()) + url + "\n"); }

/// Prints the address of --url with the operator's token.  Reason: a daemon that listens on one
/// address takes nobody for local, so it does not give out its token.
int show_own_address(const Client& client, const Arguments& arguments) {
    const Url url = parse_url(arguments.urls.front());
    if (!arguments.address.empty() && arguments.address != url.host) {
        complain(text::tr("{} is not an address of this page; allowed: {}", arguments.address,
                          url.host));
        return kRefused;
    }
    // The empty note is refused with this status, but only after the token was accepted.
    constexpr int kConflict = 409;
    const Reply reply = client.post("/api/note", "{}", arguments.token);
    if (reply.status != kConflict) {
        const std::string error = answer_of(reply).error;
        complain(error.empty() ? text::tr("the daemon answered with status {}", reply.status)
                               : error);
        return kRefused;
    }
    print_code(page_url(url.authority(), arguments.token));
    return kDone;
}

/// Prints the address of the page for a telephone, as a code and as text.
int show_phone(const Client& client, const Arguments& arguments) {
    const Answer answer = answer_of(client.get("/api/token"));
    if (!answer.error.empty() && !arguments.token.empty())
        return show_own_address(client, arguments);
    if (!answer.error.empty()) {
        complain(text::tr("{}; set A351_TOKEN to the token of [page]", answer.error));
        return kRefused;
    }
    const auto listen = answer.body.at("listen").get<std::string>();
    const std::string port = listen.substr(listen.rfind(':') + 1);
    const auto addresses = reachable_addresses(listen.substr(0, listen.rfind(':')));
    if (addresses.empty()) {
        complain(
            text::tr("other devices cannot reach the page at {}; set listen = "
                     "\"0.0.0.0:{}\" in [page], restart a351d and connect to a network",
                     listen, port));
        return kRefused;
    }
    std::string address = arguments.address.empty() ? addresses.front() : arguments.address;
    if (std::ranges::count(addresses, address) == 0) {
        complain(text::tr("{} is not an address of this page; allowed: {}", address,
                          text::joined(addresses)));
        return kRefused;
    }
    print_code(page_url(address + ":" + port, answer.body.at("token").get<std::string>()));
    for (const std::string& other : addresses)
        if (other != address)
            print(text::tr("another address: {}", "a351ctl phone " + other) + "\n");
    return kDone;
}

int show(const Client& client, const Arguments& arguments, const std::string& path,
         std::string (*table)(const json&)) {
    const auto reply = client.get(path);
    const auto answer = accepted(answer_of(reply));
    if (!answer) return kRefused;
    print(arguments.json ? reply.body : table(*answer));
    return kDone;
}

/// Shows the gravity so far, and what the signal asks.
int show_survey(const Client& client, const Arguments& arguments) {
    const int done = show(client, arguments, "/api/survey", survey_text);
    if (done != kDone || arguments.json) return done;
    const auto answer = accepted(answer_of(client.get("/api/rows")));
    if (!answer) return kRefused;
    json asked = json::array();
    for (const json& row : answer->at("rows"))
        if (row.at("label") == "signal" || row.at("label") == "commands") asked.push_back(row);
    if (asked.size() > 1) print(status_screen({{"rows", asked}}, wants_colour()));
    return kDone;
}

}  // namespace

int run_command(const std::string& command, const Arguments& arguments) {
    const bool is_for_all =
        command == "start" || command == "stop" || command == "setup" || command == "note";
    if (arguments.urls.size() > 1 && !is_for_all)
        throw InputError(
            "--url: given more than once; allowed for start, stop, setup and note only");
    if (arguments.urls.size() > 1) return change_all(arguments, command);
    const Client client(parse_url(arguments.urls.front()));
    if (command == "site") return add_site(client, arguments);
    if (command == "status") return show_status(client, arguments);
    if (command == "phone") return show_phone(client, arguments);
    if (command == "bundle") {
        print(take_home(client, files::posix_files(), arguments.out) + "\n");
        return kDone;
    }
    if (command == "sites") return show(client, arguments, "/api/sites", site_table);
    if (command == "survey") return show_survey(client, arguments);
    if (command == "list") return show(client, arguments, "/api/occupations", occupation_table);
    if (command == "checked")
        return change(client, arguments, "/api/occupation/checked", json::object());
    if (is_for_all) return change(client, arguments, path_of(command), order(client, arguments));
    return change_stay(client, arguments, command == "not-moved" ? "not_moved" : command);
}

}  // namespace a351::daemon::ctl
