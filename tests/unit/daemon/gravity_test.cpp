// The child that computes the gravity so far: whatever it does, the daemon gets an answer in time.
#include "daemon/gravity/gravity_so_far.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include "tests/support/catch.hpp"

#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::daemon::gravity;
using namespace std::chrono_literals;

namespace {

const std::atomic<bool> kGoOn{false};

ChildLimits limits() { return {.time = 60s, .output_bytes = 100'000}; }

ChildEnd run_shell(const std::string& script, const ChildLimits& most = limits()) {
    return run_child({"/bin/sh", "-c", script}, most, kGoOn);
}

/// Waits until a condition holds, at most a minute.
template <class Condition>
bool comes_true(Condition condition) {
    for (int i = 0; i < 6000 && !condition(); ++i) std::this_thread::sleep_for(10ms);
    return condition();
}

std::string content_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

nlohmann::json parsed(const GravitySoFar& gravity) {
    return nlohmann::json::parse(gravity.document());
}

}  // namespace

TEST_CASE("a child's output is returned whole", "[gravity]") {
    const ChildEnd end = run_shell("echo one; echo two; echo talk >&2");
    CHECK(end.trouble.empty());
    CHECK(end.output == "one\ntwo\n");
}

TEST_CASE("each failure of a child has its code and cause", "[gravity]") {
    const auto trouble = [](const ChildEnd& end) { return end.trouble + ": " + end.message; };
    CHECK(trouble(run_shell("echo first >&2; echo 'sites.csv: no such file' >&2; exit 2")) ==
          "failed: sites.csv: no such file");
    CHECK(trouble(run_shell("exit 3")) == "failed: it ended with status 3");
    CHECK(trouble(run_shell("kill -9 $$")) == "killed: signal 9 ended it");
    CHECK(trouble(run_child({"/nowhere/a351-correct"}, limits(), kGoOn)) ==
          "no_corrector: there is no program /nowhere/a351-correct");
    CHECK(trouble(run_shell("while :; do echo 0123456789012345678901234567890; done")) ==
          "too_much_output: it printed too much");
}

TEST_CASE("a child that hangs is killed, also if it closes its output", "[gravity]") {
    for (const char* const script : {"sleep 100", "exec >&- 2>&-; sleep 100"}) {
        const auto begin = std::chrono::steady_clock::now();
        const ChildEnd end = run_shell(script, {.time = 300ms});
        CHECK(end.trouble == "too_slow");
        CHECK(std::chrono::steady_clock::now() - begin < 5s);
    }
}

TEST_CASE("a child that uses too much processor time or memory is refused more", "[gravity]") {
    const ChildEnd busy = run_shell("while :; do :; done", {.time = 300s, .cpu_s = 1});
    CHECK(busy.trouble == "too_slow");
    CHECK(busy.message == "it reached its limit of processor time");
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    // head keeps a last "line" of 4 GiB in memory.
    CHECK(run_shell("ulimit -v", {}).output == "2097152\n");
    const ChildEnd end = run_shell("head -c 4G /dev/zero | tail -n 1 | wc -c; kill -9 $$",
                                   {.time = 60s, .memory_bytes = std::size_t{64} << 20U});
    CAPTURE(end.output, end.message);
    CHECK(end.trouble == "killed");
    CHECK(end.output == "0\n");
#endif
}

TEST_CASE("a child inherits no descriptor and no blocked signal, and is the least of processes",
          "[gravity]") {
    const int leaked = open("/dev/null", O_RDONLY);  // without O_CLOEXEC
    REQUIRE(leaked > 2);
    sigset_t term, before;
    sigemptyset(&term);
    sigaddset(&term, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &term, &before);
    const ChildEnd descriptors = run_child({"/bin/ls", "/proc/self/fd"}, limits(), kGoOn);
    const ChildEnd signals =
        run_child({"/bin/grep", "SigBlk", "/proc/self/status"}, limits(), kGoOn);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    close(leaked);
    CHECK(descriptors.output == "0\n1\n2\n3\n");  // 3 is the directory that ls reads
    CHECK(signals.output == "SigBlk:\t0000000000000000\n");
    // The 41st word of stat is the scheduling policy: 5 is SCHED_IDLE.
    const ChildEnd end = run_shell(
        "cat /proc/$$/oom_score_adj; cut -d' ' -f41 /proc/$$/stat; ulimit -t; readlink "
        "/proc/$$/fd/0",
        {});
    CHECK(end.output == "800\n5\n60\n/dev/null\n");
}

TEST_CASE("a child is gone after its daemon was killed", "[gravity]") {
    const test::TemporaryDirectory folder;
    const auto file = folder.path() / "pid";
    const pid_t daemon = fork();
    REQUIRE(daemon >= 0);
    if (daemon == 0) {
        static_cast<void>(run_shell("echo $$ > " + file.string() + "; exec sleep 100", {}));
        _exit(0);
    }
    REQUIRE(comes_true([&] { return content_of(file).ends_with('\n'); }));
    const pid_t child = std::stoi(content_of(file));
    CHECK(kill(child, 0) == 0);
    kill(daemon, SIGKILL);
    waitpid(daemon, nullptr, 0);
    CHECK(comes_true([&] {
        const std::string stat = content_of("/proc/" + std::to_string(child) + "/stat");
        return stat.empty() || stat.find(") Z") != std::string::npos;
    }));
}

TEST_CASE("the corrector runs after a change, again later, and regularly while a stay runs",
          "[gravity]") {
    const test::TemporaryDirectory folder;
    const auto file = folder.path() / "runs";
    const auto runs = [&] { return content_of(file).size(); };
    GravitySoFar gravity(
        {.command = {"/bin/sh", "-c", "printf x >> " + file.string() + "; echo '{\"stays\":[]}'"},
         .every = 100ms,
         .again = 300ms});
    CHECK(parsed(gravity).at("reason") == "not_yet");
    gravity.start();
    std::this_thread::sleep_for(200ms);
    CHECK(runs() == 0);
    gravity.note_change(false);
    CHECK(comes_true([&] { return runs() == 2; }));
    std::this_thread::sleep_for(400ms);
    CHECK(runs() == 2);
    CHECK(gravity.document() == "{\"stays\":[]}\n");
    gravity.note_change(true);
    CHECK(comes_true([&] { return runs() >= 6; }));
    gravity.stop();
}

TEST_CASE("a failure keeps the last figures, is said once, and a success ends it", "[gravity]") {
    const test::TemporaryDirectory folder;
    const auto answer = folder.write("answer", "{\"reason\":null,\"stays\":[1]}");
    std::atomic<int> said{0};
    GravitySoFar gravity({.command = {"/bin/cat", answer.string()},
                          .every = 50ms,
                          .again = 50ms,
                          .failed = [&](const std::string&, const std::string&) { ++said; }});
    gravity.start();
    gravity.note_change(true);
    REQUIRE(comes_true([&] { return parsed(gravity).at("reason").is_null(); }));
    folder.write("answer", "Segmentation fault");
    REQUIRE(comes_true([&] { return parsed(gravity).at("reason") == "no_document"; }));
    CHECK(parsed(gravity).at("stays") == nlohmann::json{1});
    CHECK(!parsed(gravity).at("reason_text").is_null());
    std::this_thread::sleep_for(300ms);
    CHECK(said == 1);
    folder.write("answer", "{\"reason\":null,\"stays\":[2]}");
    CHECK(comes_true([&] { return parsed(gravity).at("stays") == nlohmann::json{2}; }));
    CHECK(parsed(gravity).at("reason").is_null());
}

TEST_CASE("a daemon that stops ends the corrector at once", "[gravity]") {
    GravitySoFar gravity({.command = {"/bin/sleep", "100"}});
    gravity.start();
    gravity.note_change(true);
    std::this_thread::sleep_for(200ms);
    const auto begin = std::chrono::steady_clock::now();
    gravity.stop();
    CHECK(std::chrono::steady_clock::now() - begin < 2s);
}

TEST_CASE("without a command the document has the reason", "[gravity]") {
    GravitySoFar gravity({.command = {}, .reason = "no_sites"});
    gravity.start();
    gravity.note_change(true);
    CHECK(parsed(gravity).at("reason") == "no_sites");
    CHECK(parsed(gravity).at("stays").empty());
}

TEST_CASE("the command has the files of the survey, and the reason says why there is none",
          "[gravity]") {
    const auto command = options_for("/usr/bin/a351-correct", {"data", "sites.csv", {}}, 3min);
    CHECK(command.every == 3min);
    CHECK(command.reason.empty());
    CHECK(command.command == std::vector<std::string>{"/usr/bin/a351-correct", "survey", "data",
                                                      "--sites", "sites.csv", "--json"});
    const auto calibrated =
        options_for("/usr/bin/a351-correct", {"data", "sites.csv", "unit.toml"}, 3min).command;
    REQUIRE(calibrated.size() == command.command.size() + 2);
    CHECK(calibrated[6] == "--calibration");
    CHECK(calibrated[7] == "unit.toml");
    const auto off = options_for("a351-correct", {"data", "sites.csv", "unit.toml"}, 0ms);
    CHECK(off.reason == "off");
    CHECK(off.command.empty());
    CHECK(options_for("a351-correct", {"data", {}, {}}, 3min).reason == "no_sites");
}
