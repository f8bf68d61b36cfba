#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

#include "daemon/ctl/client.hpp"
#include "daemon/ctl/screen.hpp"
#include "daemon/page/server.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/unit/daemon/fake_recorder.hpp"

using namespace a351;
using namespace a351::daemon;

namespace {

struct Run {
    int exit = -1;
    std::string text;  ///< stdout and stderr.
};

Run run(const std::string& arguments) {
    const std::string command = std::string(A351CTL) + " " + arguments + " 2>&1";
    Run result;
    FILE* pipe = popen(command.c_str(), "r");
    REQUIRE(pipe);
    char bytes[4096];
    while (const auto got = std::fread(bytes, 1, sizeof bytes, pipe)) {
        result.text.append(bytes, got);
    }
    const int status = pclose(pipe);
    result.exit = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    CAPTURE(arguments, result.text);
    CHECK(result.exit >= 0);
    return result;
}

/// The HTTP interface of a daemon without the rest of the daemon.
struct FakeDaemon {
    explicit FakeDaemon(Status::Level level = Status::Level::good) {
        status.level = level;
        status.now = status.last_sample.emplace(minute(60));
        server.start();
    }
    Run ctl(const std::string& arguments) const {
        return run("--url http://127.0.0.1:" + std::to_string(server.port()) + " " + arguments);
    }

    FakeRecorder recorder;
    Occupations occupations{recorder, two_sites(), {}};
    LiveRecord live{*wire::find_profile("A351"), 50, {}};
    Status status;
    Server server{{.listen = {.port = 0}},
                  {.status = [this] { return status; },
                   .occupations = occupations,
                   .live = live,
                   .events = [this] { return recorder.log; }}};
};

bool has(const Run& result, const std::string& text) {
    CAPTURE(result.exit, result.text);
    return result.text.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("the exit code of status is that of a monitoring plugin", "[daemon][ctl]") {
    for (const auto& [level, exit] :
         {std::pair(Status::Level::good, 0), std::pair(Status::Level::warning, 1),
          std::pair(Status::Level::fault, 2)}) {
        const FakeDaemon daemon(level);
        CHECK(daemon.ctl("status").exit == exit);
        const auto raw = daemon.ctl("status --json");
        CHECK(raw.exit == exit);
        CHECK(nlohmann::json::parse(raw.text).at("timing").at("state") == "unlocked");
    }
    CHECK(run("--url http://127.0.0.1:1 status").exit == 3);
    CHECK(run("status --bogus").exit == 3);
    CHECK(run("--url ftp://127.0.0.1 status").exit == 3);
}

TEST_CASE("other commands exit with 0 if done, 1 if refused, 2 for wrong usage, 3 without a daemon",
          "[daemon][ctl]") {
    FakeDaemon daemon;
    const auto started =
        daemon.ctl("start No.0 --at 2026-03-14T08:10:00Z --operator 'M. Ito' --note windy");
    CHECK(started.exit == 0);
    CHECK(has(started, "started No.0 at 2026-03-14T08:10:00.0Z"));
    const auto again = daemon.ctl("start No.1");
    CHECK(again.exit == 1);
    CHECK(has(again, "a351ctl: No.0 (stay 1) has been running"));
    CHECK(daemon.ctl("setup --at 2026-03-14T08:20:00Z").exit == 0);
    CHECK(daemon.ctl("note 'a lorry passed'").exit == 0);
    CHECK(daemon.ctl("rename No.1").exit == 0);
    CHECK(has(daemon.ctl("status"), "No.1, stay 1, since 2026-03-14T08:10:00.000Z"));
    CHECK(daemon.ctl("stop --at 2026-03-14T08:30:00Z").exit == 0);
    CHECK(daemon.ctl("stop").exit == 1);
    CHECK(has(daemon.ctl("list"), "2026-03-14T08:30:00.000Z"));
    CHECK(daemon.ctl("discard").exit == 0);
    CHECK_FALSE(has(daemon.ctl("list"), "No.1"));
    CHECK(has(daemon.ctl("sites"), "979948.000"));

    for (const char* wrong : {"", "start", "stop --at noon", "fly", "note", "--clock fast stop",
                              "start No.0 --bogus", "--url nowhere stop"}) {
        const auto result = run(wrong);
        CAPTURE(wrong, result.text);
        CHECK(result.exit == 2);
        CHECK(std::count(result.text.begin(), result.text.end(), '\n') == 1);
    }
    const auto nobody = run("--url http://127.0.0.1:1 stop");
    CHECK(nobody.exit == 3);
    CHECK(has(nobody, "a351ctl: no daemon answers at http://127.0.0.1:1"));
    CHECK(std::count(nobody.text.begin(), nobody.text.end(), '\n') == 1);
    CHECK(run("--help").exit == 0);
    CHECK(has(run("--version"), A351_VERSION));
    CHECK(daemon.ctl("--clock scaled:60@2026-03-14T08:00:00Z sites").exit == 0);
}

TEST_CASE("options of the command line are in the recorded event", "[daemon][ctl]") {
    FakeDaemon daemon;
    daemon.ctl("start No.0 --at 2026-03-14T08:10:00Z --operator 'M. Ito' --note windy");
    daemon.server.stop();
    REQUIRE(daemon.recorder.log.size() == 1);
    CHECK(daemon.recorder.log.front().utc == minute(10));
    CHECK(daemon.recorder.log.front().details.at("operator") == "M. Ito");
    CHECK(daemon.recorder.log.front().details.at("note") == "windy");
}

TEST_CASE("a command with a wrong token is refused", "[daemon][ctl]") {
    const FakeDaemon daemon;
    CHECK(daemon.ctl("--token 0123456789abcdef discard").exit == 1);
}

TEST_CASE("watch runs until it is interrupted, even without a daemon", "[daemon][ctl]") {
    const FakeDaemon daemon;
    const auto url = "http://127.0.0.1:" + std::to_string(daemon.server.port());
    const auto seen = run("--url " + url + " watch & sleep 0.6; kill -INT $!; wait $!");
    CHECK(seen.exit == 0);
    CHECK(has(seen, "occupation   none running"));
    CHECK(seen.text.find('\x1b') == std::string::npos);
    const auto lonely = run("--url http://127.0.0.1:1 watch & sleep 0.6; kill -INT $!; wait $!");
    CHECK(lonely.exit == 0);
    CHECK(has(lonely, "no daemon answers"));
}

TEST_CASE("the status screen shows known values and a dash for missing ones", "[daemon][ctl]") {
    const auto bare = status_screen(nlohmann::json::object(), false);
    CHECK(bare.find("temperature  -\n") != std::string::npos);
    const auto odd = nlohmann::json::parse(
        R"({"level":7,"device":[],"counters":"x","sample":{"acceleration_mg":[1]},"received":"?"})");
    CHECK(status_screen(odd, false).find("axes         -\n") != std::string::npos);
    CHECK(plugin_status(odd) == 3);
    const auto full = nlohmann::json::parse(R"({
        "level":"warning","reasons":["disk nearly full"],"received":1000,"journaled":990,
        "device":{"output_rate_hz":50},"sample":{"acceleration_mg":[1.5,-2.25,999.3]},
        "counters":{"gaps":2,"duplicates":0,"frames":1000,"journal_bytes":24000,"archive_records":5},
        "verdict":{"state":"no data","held_s":null,"reasons":["no sample has been received yet"]},
        "disk":{"free_bytes":5500000000}})");
    const auto screen = status_screen(full, false);
    CHECK(screen.find("warning: disk nearly full") != std::string::npos);
    CHECK(screen.find("990, 10 behind (0.2 s)") != std::string::npos);
    CHECK(screen.find("x 1.500   y -2.250   z 999.300 mg") != std::string::npos);
    CHECK(screen.find("troubles     gaps 2\n") != std::string::npos);
    CHECK(screen.find("verdict      no data: no sample has been received yet\n") !=
          std::string::npos);
    CHECK(screen.find("5.5 GB free") != std::string::npos);
    CHECK(screen.find('\x1b') == std::string::npos);
    CHECK(status_screen(full, true).find("\x1b[1;33mwarning") != std::string::npos);
}

TEST_CASE("the status screen shows the oven in one line", "[daemon][ctl]") {
    const auto line_of = [](const char* oven) {
        const auto screen =
            status_screen(nlohmann::json{{"oven", nlohmann::json::parse(oven)}}, false);
        const auto begin = screen.find("\noven  ") + 14;
        return screen.substr(begin, screen.find('\n', begin) - begin);
    };
    CHECK(line_of(R"({"state":"disabled"})") == "disabled");
    CHECK(line_of(R"({"state":"searching","trouble":"oven: not there","age_s":null})") ==
          "searching: oven: not there");
    CHECK(line_of(R"({"state":"answering","process_value_degc":42.5,"set_point_degc":43.0,
                      "heating_percent":25.0,"has_input_error":false,"age_s":0.4,
                      "is_stale":false})") ==
          "42.5 degC, set point 43.0 degC, heating 25.0 %, answering");
    CHECK(line_of(R"({"state":"silent","process_value_degc":null,"set_point_degc":43.0,
                      "heating_percent":0.0,"has_input_error":true,"age_s":64.2,
                      "is_stale":true})") ==
          "-, set point 43.0 degC, heating 0.0 %, input error, silent, 64 s old");
}

TEST_CASE("control characters in names do not reach the terminal", "[daemon][ctl]") {
    CHECK(printable("No.0 \xC3\xA9") == "No.0 \xC3\xA9");
    CHECK(printable("\x1b[2J\x07\n\x7f") == "?[2J???");
    CHECK(printable("\xC2\x9B"
                    "2J") == "?2J");
    const nlohmann::json hostile = {{"occupation", {{"site", "\x1b]0;x\x07"}}}};
    CHECK(status_screen(hostile, false).find('\x1b') == std::string::npos);
}

TEST_CASE("the URL of a daemon is http, a host and an optional port", "[daemon][ctl]") {
    CHECK(parse_url("http://127.0.0.1:8351").authority() == "127.0.0.1:8351");
    CHECK(parse_url("http://[::1]:8351/").authority() == "[::1]:8351");
    CHECK(parse_url("http://gravbox").authority() == "gravbox:80");
    for (const char* odd : {"", "127.0.0.1:8351", "https://x", "http://", "http://:8351",
                            "http://x:", "http://x:port", "http://x/y", "http://[::1", "http://a b",
                            "http://u@x", "http://x:8351:1"}) {
        CAPTURE(odd);
        CHECK_THROWS_AS(parse_url(odd), InputError);
    }
}
