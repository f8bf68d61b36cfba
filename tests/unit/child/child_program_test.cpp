// Runs of another program: whatever it does, the caller gets an answer in time.
#include "protocol/child/child_program.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>
#include "tests/support/catch.hpp"

#include "tests/support/path_variable.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::child;
using namespace std::chrono_literals;

namespace {

ChildLimits limits() { return {.time = 60s, .output_bytes = 100'000}; }

ChildEnd run_shell(const std::string& script, const ChildLimits& most = limits()) {
    return run_child({.words = {"/bin/sh", "-c", script}}, most);
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

/// Returns true if the process has ended, reaped or not.
bool is_gone(const std::string& number) {
    const std::string stat = content_of("/proc/" + number + "/stat");
    return stat.empty() || stat.find(") Z") != std::string::npos;
}

void check_end(const ChildEnd& end, Outcome outcome, int status, const std::string& message) {
    CAPTURE(end.message, end.output);
    CHECK(end.outcome == outcome);
    CHECK(end.status == status);
    CHECK(end.message == message);
}

}  // namespace

TEST_CASE("the output of a child is returned whole, and its talk is no message") {
    const ChildEnd end = run_shell("echo one; echo two; echo talk >&2");
    check_end(end, Outcome::good, 0, "");
    CHECK(end.output == "one\ntwo\n");
}

TEST_CASE("words, directory and variables reach the program without a shell") {
    const test::TemporaryDirectory folder;
    ::setenv("A351_TEST", "inherited", 1);
    ::setenv("A351_TEST_OTHER", "kept", 1);
    const ChildEnd end = run_child(
        {.words = {"sh", "-c", "pwd; echo \"$1 $A351_TEST $A351_TEST_OTHER\"", "sh", "a`b` $c"},
         .directory = folder.path(),
         .variables = {"A351_TEST=given"}});
    CHECK(end.output == folder.path().string() + "\na`b` $c given kept\n");
}

TEST_CASE("each failure of a child has its outcome and cause") {
    check_end(run_shell("echo first >&2; echo 'sites.csv: no such file' >&2; exit 2"),
              Outcome::failed, 2, "sites.csv: no such file");
    check_end(run_shell("exit 3"), Outcome::failed, 3, "it ended with status 3");
    check_end(run_shell("kill -9 $$"), Outcome::killed, 9, "signal 9 ended it");
    check_end(run_child({.words = {"/nowhere/a351-correct"}}), Outcome::missing, 0,
              "there is no program /nowhere/a351-correct");
    check_end(run_shell("while :; do echo 0123456789012345678901234567890; done"),
              Outcome::too_much_output, 0, "it printed too much");
    check_end(run_shell("head -c 200000 /dev/zero"), Outcome::too_much_output, 0,
              "it printed too much");
}

TEST_CASE("a program is looked up in PATH, and only an executable file counts") {
    const test::TemporaryDirectory folder;
    const PathVariable path(folder.write("no-folder", "").string() + "::" + folder.path().string());
    const auto outcome = [&](const std::string& name) {
        return run_child({.words = {name}, .directory = "/"}).outcome;
    };
    CHECK(outcome("a351-program") == Outcome::missing);
    const auto file = folder.write("a351-program", "#!/bin/sh\nexit 0\n");
    CHECK(outcome("a351-program") == Outcome::missing);  // not executable
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    CHECK(outcome("a351-program") == Outcome::good);
    CHECK(outcome(file) == Outcome::good);
    CHECK(outcome(folder.path()) == Outcome::missing);
    const auto deep = folder.path() / "1/2/3/4/5/6/7/8/9";
    std::filesystem::create_directories(deep);
    CHECK(run_child({.words = {std::filesystem::relative(file)}, .directory = deep}).outcome ==
          Outcome::good);
    folder.write("a351-program", "no program\n");
    check_end(run_child({.words = {"a351-program"}}), Outcome::failed, 127,
              "the host refuses to start it");
}

TEST_CASE("a working directory that is missing is an exception, and nothing is started") {
    CHECK_THROWS_AS(run_child({.words = {"/bin/true"}, .directory = "/nowhere"}),
                    std::system_error);
}

TEST_CASE("a child that hangs is killed, also if it closes its output") {
    for (const char* const script : {"sleep 100", "exec >&- 2>&-; sleep 100"}) {
        const auto begin = std::chrono::steady_clock::now();
        check_end(run_shell(script, {.time = 300ms}), Outcome::too_slow, 0,
                  "it reached its time limit");
        CHECK(std::chrono::steady_clock::now() - begin < 5s);
    }
}

TEST_CASE("a child is stopped on request, with what it has started") {
    const test::TemporaryDirectory folder;
    const auto file = folder.path() / "pid";
    std::atomic<bool> stop{false};
    ChildEnd end;
    std::thread caller([&] {
        end = run_child(
            {.words = {"/bin/sh", "-c", "sleep 100 & echo $! > " + file.string() + "; wait"}}, {},
            &stop);
    });
    CHECK(comes_true([&] { return content_of(file).ends_with('\n'); }));
    stop = true;
    caller.join();
    check_end(end, Outcome::stopped, 0, "");
    const std::string number = std::to_string(std::stoi(content_of(file)));
    CHECK(comes_true([&] { return is_gone(number); }));
}

TEST_CASE("a process that a child left behind is not waited for") {
    const auto begin = std::chrono::steady_clock::now();
    const ChildEnd end = run_shell("sleep 20 & echo $!");
    CHECK(end.outcome == Outcome::good);
    CHECK(std::chrono::steady_clock::now() - begin < 10s);
    ::kill(std::stoi(end.output), SIGKILL);
}

TEST_CASE("a child that uses too much processor time or memory is refused more") {
    check_end(run_shell("while :; do :; done", {.time = 300s, .cpu_s = 1}), Outcome::too_slow, 0,
              "it reached its limit of processor time");
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    // head keeps a last "line" of 4 GiB in memory.
    const ChildEnd end = run_shell("head -c 4G /dev/zero | tail -n 1 | wc -c; kill -9 $$",
                                   {.time = 60s, .memory_bytes = std::size_t{64} << 20U});
    CAPTURE(end.output, end.message);
    CHECK(end.outcome == Outcome::killed);
    CHECK(end.output == "0\n");
#endif
}

TEST_CASE("a child inherits no descriptor, no blocked and no ignored signal") {
    const int leaked = open("/dev/null", O_RDONLY);  // without O_CLOEXEC
    REQUIRE(leaked > 2);
    sigset_t term, before;
    sigemptyset(&term);
    sigaddset(&term, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &term, &before);
    const auto handler = ::signal(SIGUSR1, SIG_IGN);
    const ChildEnd descriptors = run_child({.words = {"ls", "/proc/self/fd"}});
    const ChildEnd signals = run_child({.words = {"grep", "Sig[BI]", "/proc/self/status"}});
    sigset_t after;
    pthread_sigmask(SIG_SETMASK, &before, &after);
    ::signal(SIGUSR1, handler);
    close(leaked);
    CHECK(descriptors.output == "0\n1\n2\n3\n");  // 3 is the directory that ls reads
    CHECK(signals.output == "SigBlk:\t0000000000000000\nSigIgn:\t0000000000000000\n");
    CHECK(sigismember(&after, SIGTERM) == 1);
    CHECK(sigismember(&after, SIGINT) == 0);
}

TEST_CASE("a child in the background is the least of processes, another is not") {
    // The 41st word of stat is the scheduling policy: 5 is SCHED_IDLE.
    const std::string script =
        "cat /proc/$$/oom_score_adj; cut -d' ' -f41 /proc/$$/stat; ulimit -t; ulimit -v; ulimit "
        "-c; readlink /proc/$$/fd/0";
    const Command background{.words = {"/bin/sh", "-c", script}, .is_background = true};
    CHECK(run_child(background, {.cpu_s = 60, .memory_bytes = std::size_t{2} << 30U}).output ==
          "800\n5\n60\n2097152\n0\n/dev/null\n");
    CHECK(run_shell("cut -d' ' -f41 /proc/$$/stat").output == "0\n");
}

TEST_CASE("a child has its streams, also if the caller has closed its own") {
    const test::TemporaryDirectory folder;
    const auto file = folder.path() / "output";
    const pid_t caller = fork();
    REQUIRE(caller >= 0);
    if (caller == 0) {
        for (int stream = 0; stream < 3; ++stream) close(stream);
        const ChildEnd end = run_shell("read line; echo \"$?\"; echo error >&2; exit 4");
        std::ofstream(file) << end.output << end.message << end.status;
        _exit(0);
    }
    waitpid(caller, nullptr, 0);
    CHECK(content_of(file) == "1\nerror4");
}

TEST_CASE("no run leaves a zombie") {
    std::ignore = run_shell("exit 0");
    std::ignore = run_shell("exit 1");
    std::ignore = run_shell("sleep 100", {.time = 1ms});
    CHECK(waitpid(-1, nullptr, WNOHANG) == -1);
    CHECK(errno == ECHILD);
}

TEST_CASE("a status that nobody can read is an exception, not a success") {
    const auto before = ::signal(SIGCHLD, SIG_IGN);
    CHECK_THROWS_AS(run_shell("exit 3"), std::system_error);
    ::signal(SIGCHLD, before);
}

TEST_CASE("a child is gone after its caller was killed") {
    const test::TemporaryDirectory folder;
    const auto file = folder.path() / "pid";
    const pid_t caller = fork();
    REQUIRE(caller >= 0);
    if (caller == 0) {
        std::ignore = run_shell("echo $$ > " + file.string() + "; exec sleep 100");
        _exit(0);
    }
    REQUIRE(comes_true([&] { return content_of(file).ends_with('\n'); }));
    const std::string number = std::to_string(std::stoi(content_of(file)));
    CHECK_FALSE(is_gone(number));
    kill(caller, SIGKILL);
    waitpid(caller, nullptr, 0);
    CHECK(comes_true([&] { return is_gone(number); }));
}
