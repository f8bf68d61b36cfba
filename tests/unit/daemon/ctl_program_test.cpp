#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <nlohmann/json.hpp>
#include "protocol/text/text_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/daemon/pty.hpp"
#include "tests/unit/daemon/served.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::status;

namespace {

struct Run {
    int exit = -1;
    std::string text;  ///< stdout and stderr.
};

Run run(const std::string& arguments) {
    const std::string command = std::string(A351CTL) + " 2>&1 " + arguments;
    Run result;
    FILE* pipe = popen(command.c_str(), "r");
    REQUIRE(pipe);
    char bytes[4096];
    while (const auto got = std::fread(bytes, 1, sizeof bytes, pipe))
        result.text.append(bytes, got);
    const int status = pclose(pipe);
    result.exit = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    CAPTURE(arguments, result.text);
    CHECK(result.exit >= 0);
    return result;
}

/// The HTTP interface of a daemon without the rest of the daemon.
struct FakeDaemon : Served {
    explicit FakeDaemon(Status::Level level = Status::Level::good, UtcTime last = minute(60),
                        const std::vector<text::Message>& troubles = {}) {
        const std::lock_guard lock(mutex);
        recorder.last = last;
        status.sensor_troubles = troubles;
        status.level = level;
        status.verdict.state = verdict::State::stable;
        status.now = status.last_sample.emplace(last);
    }
    [[nodiscard]] std::string url() const {
        return "http://127.0.0.1:" + std::to_string(server.port());
    }
    Run ctl(const std::string& arguments) const { return run("--url " + url() + " " + arguments); }
};

bool has(const Run& result, const std::string& text) {
    CAPTURE(result.exit, result.text);
    return result.text.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("the exit code of status is that of a monitoring plugin") {
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

TEST_CASE("with LOOK status and survey have the commands that answer it") {
    CHECK_FALSE(has(FakeDaemon().ctl("survey"), "signal"));
    const FakeDaemon daemon(Status::Level::good, minute(60), {"the x axis is dead"});
    for (const char* command : {"status", "survey"}) {
        const auto screen = daemon.ctl(command);
        CHECK(has(screen, "signal       LOOK: the x axis is dead\ncommands     a351ctl checked\n"));
    }
}

TEST_CASE("a terminal that takes no output is not a good state") {
    const FakeDaemon daemon;
    CHECK(daemon.ctl("status > /dev/full").exit == 3);
    CHECK(daemon.ctl("list > /dev/full").exit == 1);
    CHECK(daemon.ctl("list > /dev/full").text.find("output could not be written") !=
          std::string::npos);
}

TEST_CASE(
    "other commands exit with 0 if done, 1 if refused, 2 for wrong usage, 3 without a daemon") {
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
    CHECK(has(daemon.ctl("rename No.1"), "No.0, stay 1 (20260314T081000Z), running since"));
    CHECK(has(daemon.ctl("status"), "No.1, stay 1, since 2026-03-14T08:10:00.000Z"));
    CHECK(daemon.ctl("stop --at 2026-03-14T08:30:00Z").exit == 0);
    CHECK(daemon.ctl("stop").exit == 1);
    CHECK(has(daemon.ctl("list"), "2026-03-14T08:30:00.000Z"));
    CHECK(daemon.ctl("retime 20260314T081000Z --from 2026-03-14T08:11:00Z").exit == 0);
    CHECK(daemon.ctl("rename 20260314T081000Z No.0 --reason 'wrong name'").exit == 0);
    const auto discarded = daemon.ctl("discard");
    CHECK(discarded.exit == 0);
    CHECK(has(discarded, "discard: No.0, stay 1 (20260314T081000Z), 2026-03-14T08:11:00.000Z"));
    CHECK(has(daemon.ctl("list"), "discarded"));
    CHECK(has(daemon.ctl("discard"), "there is no stay for this command"));
    CHECK(daemon.ctl("restore 20260314T081000Z").exit == 0);
    CHECK(has(daemon.ctl("note --stay 20260314T081000Z calm"), "for No.0 (stay 1)"));
    CHECK(daemon.ctl("resume").exit == 1);  // stopped half an hour ago
    CHECK(has(daemon.ctl("survey"), "no new figures: no_sites"));
    CHECK(nlohmann::json::parse(daemon.ctl("survey --json").text)["reason"] == "no_sites");
    CHECK(nlohmann::json::parse(daemon.ctl("list --json").text)["occupations"].size() == 1);
    CHECK(daemon.ctl("start No.1 --at -10min").exit == 0);
    CHECK(has(daemon.ctl("status"), "since 2026-03-14T08:50:00"));
    CHECK(has(daemon.ctl("sites"), "979948.000"));

    for (const char* wrong : {"", "start", "stop --at noon", "fly", "note", "--clock fast stop",
                              "start No.0 --bogus", "--url nowhere stop"}) {
        const auto result = run(wrong);
        CAPTURE(wrong, result.text);
        CHECK(result.exit == 2);
        CHECK(std::count(result.text.begin(), result.text.end(), '\n') == 1);
    }
    CHECK(has(run("fly"), "a351ctl: fly is not a command; allowed: status, start, stop,"));
    CHECK(has(run(""), "a351ctl: no command is given; allowed: status"));
    CHECK(has(run("stop now"), "a351ctl: now is not an argument of stop; see a351ctl stop --help"));
    CHECK(has(run("restore"), "a351ctl: the key of the stay is missing; a351ctl list shows it"));
    CHECK(run("restore").exit == 2);
    const auto nobody = run("--url http://127.0.0.1:1 stop");
    CHECK(nobody.exit == 3);
    CHECK(has(nobody, "a351ctl: no daemon answers at http://127.0.0.1:1"));
    CHECK(std::count(nobody.text.begin(), nobody.text.end(), '\n') == 1);
    CHECK(run("--help").exit == 0);
    CHECK(has(run("--version"), A351_VERSION));
    CHECK(daemon.ctl("--clock scaled:60@2026-03-14T08:00:00Z sites").exit == 0);
    CHECK(daemon.ctl("--token 0123456789abcdef discard").exit == 1);
    setenv("A351_URL", daemon.url().c_str(), 1);
    CHECK(has(run("sites"), "979948.000"));
    unsetenv("A351_URL");
    daemon.server.stop();
    const events::Event& start = daemon.recorder.log.front();
    CHECK(start.utc == minute(10));
    CHECK(start.details.at("operator") == "M. Ito");
    CHECK(start.details.at("note") == "windy");
}

TEST_CASE("a daemon that hangs is named, and an order that it may still carry out") {
    // The kernel accepts the connections, and nobody reads them.
    const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* any = reinterpret_cast<sockaddr*>(&address);
    REQUIRE(::bind(listener, any, size) == 0);
    REQUIRE(::listen(listener, 2) == 0);
    REQUIRE(::getsockname(listener, any, &size) == 0);
    const std::string url = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    auto asked = std::async([&] { return run("--url " + url + " status"); });
    const auto ordered = run("--url " + url + " --token 0123456789abcdef stop");
    const std::string hangs = "a351ctl: the daemon at " + url + " gave no answer within ";
    CHECK(ordered.exit == 3);
    CHECK(has(ordered, "a351ctl: no answer from " + url + " yet, its disk may be busy: waiting\n"));
    CHECK(has(ordered, " s; it may still carry this out"));
    const auto status = asked.get();
    CHECK(status.exit == 3);
    CHECK(has(status, " s; try again"));
    CHECK(has(status, hangs));
    ::close(listener);
}

TEST_CASE("several daemons start, set up and stop at one common instant") {
    FakeDaemon one, other(Status::Level::good, minute(60) - std::chrono::seconds(4));
    const std::string both = "--url " + one.url() + " --url " + other.url() + " ";
    const auto started = run(both + "start No.0 --at 2026-03-14T08:20:00Z");
    CHECK(started.exit == 0);
    for (const FakeDaemon* daemon : {&one, &other})
        CHECK(has(started, daemon->url() + ": started No.0 at 2026-03-14T08:20:00.0Z"));
    CHECK(run(both + "setup --at 2026-03-14T08:30:00Z").exit == 0);
    CHECK(one.ctl("stop").exit == 0);
    const auto stopped = run(both + "stop");
    CHECK(stopped.exit == 1);
    CHECK(has(stopped, "a351ctl: " + one.url() + ": no occupation is running"));
    CHECK(has(stopped, other.url() + ": stopped No.0 (stay 1) at 2026-03-14T08:59:56.0Z"));
    CHECK(run(both + "list").exit == 2);
    // One that is dead or gets no samples does not hinder the others; the rest is repeated.
    const FakeDaemon unplugged(Status::Level::good, minute(50));
    const auto partly = run(both + "--url http://127.0.0.1:1 --url " + unplugged.url() +
                            " start No.1 --at 2026-03-14T09:00:00Z");
    CHECK(partly.exit == 1);
    CHECK(has(partly, "a351ctl: http://127.0.0.1:1: no daemon answers at"));
    CHECK(has(partly, "a351ctl: " + unplugged.url() + ": "));
    CHECK(has(partly, "is later than the last sample"));
    CHECK(has(partly, one.url() + ": started No.1 at"));
    CHECK(has(partly, "a351ctl: repeat it with --at 2026-03-14T09:00:00.000000000Z; boxes that"));
    CHECK(run("--url http://127.0.0.1:1 --url http://127.0.0.1:2 start No.0").exit == 3);
    const auto noted = run(both + "note 'wind from the west'");
    CHECK(noted.exit == 0);
    CHECK(has(noted, other.url() + ": "));
    one.server.stop();
    other.server.stop();
    CHECK(one.recorder.log.size() == 5);
    CHECK(other.recorder.log[2].utc ==
          minute(60) - std::chrono::seconds(4));  // The last sample that both have.
}

TEST_CASE("a box with a clock that is far ahead or behind does not stop the order to the others") {
    FakeDaemon one, other(Status::Level::good, minute(60) - std::chrono::seconds(1));
    for (const int last : {50, 70}) {
        FakeDaemon wrong(Status::Level::good, minute(last));
        const auto ordered = run("--url " + wrong.url() + " --url " + one.url() + " --url " +
                                 other.url() + " start No.0");
        CAPTURE(ordered.text);
        CHECK(ordered.exit == 1);
        CHECK(has(ordered,
                  "a351ctl: " + wrong.url() + ": left out: its last sample is " +
                      (last == 50 ? "599 s behind the others;" : "600 s ahead of the others;")));
        for (const FakeDaemon* daemon : {&one, &other})
            CHECK(has(ordered,
                      daemon->url() + (last == 50 ? ": started No.0 at 2026-03-14T08:59:59.0Z"
                                                  : ": No.0 (stay 1) is running since "
                                                    "2026-03-14T08:59:59.0Z, as ordered")));
        CHECK_FALSE(has(ordered, "repeat it with"));  // Its data have another time there.
        wrong.server.stop();
        CHECK(wrong.recorder.log.empty());
    }
    // With two boxes, the one that receives samples gives the instant.
    FakeDaemon unplugged(Status::Level::good, minute(40));
    unplugged.status.now = minute(60);
    const auto stopped = run("--url " + unplugged.url() + " --url " + one.url() + " start No.1");
    CHECK(has(stopped, "left out: its last sample is 1200 s behind the others"));
    CHECK(has(stopped, one.url() + ": No.0 (stay 1) has been running since"));
}

TEST_CASE("a site is added in the terminal, and a refusal is one line") {
    FakeDaemon daemon;
    const test::TemporaryDirectory directory;
    const auto file = directory.write(
        "sites.csv", "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\nA,140,36,1,\n");
    std::promise<void> is_used;
    daemon.server.post([&] {
        daemon.occupations.use(text::read_sites(file), {.sites_file = file});
        is_used.set_value();
    });
    is_used.get_future().wait();
    const std::string place = " --latitude 36.25 --longitude 140.125";
    const auto added = daemon.ctl("site add 'B 1'" + place + " --height 12.5 --gravity 979800.25");
    CHECK(added.exit == 0);
    CHECK(has(added, "added B 1: 2 sites in"));
    CHECK(text::read_text_file(file).ends_with("\nB 1,140.125,36.25,12.5,979800.25\n"));
    CHECK(daemon.ctl("site add C" + place).exit == 0);
    CHECK(has(daemon.ctl("sites"), "C     140.125000     36.250000     -"));
    for (const std::string wrong : {"A", "'a,b'", "\"$(printf '\\203\\145')\"", "''"}) {
        const auto refused = daemon.ctl("site add " + wrong + place);
        CAPTURE(wrong, refused.text);
        CHECK(refused.exit == 1);
        CHECK(std::count(refused.text.begin(), refused.text.end(), '\n') == 1);
    }
    CHECK(daemon.ctl("site add D --latitude 36").exit == 2);
    CHECK(daemon.ctl("site").exit == 2);
    daemon.server.stop();
    CHECK(daemon.occupations.sites().size() == 3);
}

TEST_CASE("the status is coloured on a terminal that can show colours, and nowhere else") {
    const FakeDaemon daemon;
    const auto shown = [&](const std::string& environment) {
        Pty pty;
        const std::string command = "env -u NO_COLOR " + environment + " " A351CTL " --url " +
                                    daemon.url() + " status > " + pty.path() + " 2>&1";
        CHECK(std::system(command.c_str()) == 0);
        const auto bytes = pty.read(std::chrono::seconds(1));
        std::string text;
        for (const std::byte byte : bytes) text += static_cast<char>(byte);
        CHECK(text.find("occupation   none running") != std::string::npos);
        return text;
    };
    CHECK(shown("TERM=xterm").find("\x1b[1;32mgood") != std::string::npos);
    CHECK(shown("TERM=xterm NO_COLOR=1").find('\x1b') == std::string::npos);
    CHECK(shown("TERM=dumb").find('\x1b') == std::string::npos);
    CHECK(daemon.ctl("status").text.find('\x1b') == std::string::npos);
}
