// The child that computes the gravity so far: whatever it does, the daemon gets an answer in time.
#include "daemon/gravity/gravity_so_far.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::daemon::gravity;
using namespace std::chrono_literals;

namespace {

/// Waits until a condition holds, at most five minutes: the corrector has only the time that is idle.
template <class Condition>
bool comes_true(Condition condition) {
    for (int i = 0; i < 30000 && !condition(); ++i) std::this_thread::sleep_for(10ms);
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

TEST_CASE("each failure of the corrector has its code and cause") {
    const auto reasons = [](std::vector<std::string> command) {
        GravitySoFar gravity({.command = std::move(command),
                              .limits = {.time = 10min, .cpu_s = 1, .output_bytes = 100}});
        gravity.start();
        gravity.note_change(false);
        CHECK(comes_true([&] { return parsed(gravity).at("reason") != "not_yet"; }));
        const nlohmann::json document = parsed(gravity);
        return document.at("reason").get<std::string>() + ": " +
               document.at("reason_text").get<std::string>();
    };
    const auto shell = [&](const std::string& script) {
        return reasons({"/bin/sh", "-c", script});
    };
    CHECK(shell("echo 'sites.csv: no such file' >&2; exit 2") == "failed: sites.csv: no such file");
    CHECK(shell("kill -9 $$") == "killed: signal 9 ended it");
    CHECK(shell("while :; do :; done") == "too_slow: it reached its limit of processor time");
    CHECK(shell("head -c 200 /dev/zero") == "too_much_output: it printed too much");
    CHECK(shell("echo []") == "no_document: its output is not a JSON object");
    CHECK(reasons({"/nowhere/a351-correct"}) ==
          "no_corrector: there is no program /nowhere/a351-correct");
}

TEST_CASE("the corrector runs in the background and within limits") {
    // The 41st word of stat is the scheduling policy: 5 is SCHED_IDLE.
    const std::string script =
        "printf '{\"reason\":null,\"is\":\"%s %s %s\"}' $(cut -d' ' -f41 /proc/$$/stat) "
        "$(ulimit -t) $(ulimit -v)";
    GravitySoFar gravity({.command = {"/bin/sh", "-c", script}});
    gravity.start();
    gravity.note_change(false);
    CHECK(comes_true([&] { return parsed(gravity).at("reason").is_null(); }));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    CHECK(parsed(gravity).at("is") == "5 60 2097152");
#endif
}

TEST_CASE("the corrector runs after a change, again later, and regularly while a stay runs") {
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

TEST_CASE("a failure keeps the last figures, is said once, and a success ends it") {
    const test::TemporaryDirectory folder;
    const auto answer =
        folder.write("answer", "{\"reason\":null,\"reason_parts\":[[\"old\",[]]],\"stays\":[1]}");
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
    CHECK(parsed(gravity).at("reason_parts").is_null());
    std::this_thread::sleep_for(300ms);
    CHECK(said == 1);
    folder.write("answer", "{\"reason\":null,\"stays\":[2]}");
    CHECK(comes_true([&] { return parsed(gravity).at("stays") == nlohmann::json{2}; }));
    CHECK(parsed(gravity).at("reason").is_null());
}

TEST_CASE("a daemon that stops ends the corrector at once") {
    GravitySoFar gravity({.command = {"/bin/sleep", "100"}});
    gravity.start();
    gravity.note_change(true);
    std::this_thread::sleep_for(200ms);
    const auto begin = std::chrono::steady_clock::now();
    gravity.stop();
    CHECK(std::chrono::steady_clock::now() - begin < 2s);
}

TEST_CASE("another list of sites is used at once, and figures of the old one are not shown") {
    const auto says = [](const char* stays) {
        return GravityOptions{
            .command = {"/bin/echo", std::string("{\"reason\":null,\"stays\":") + stays + "}"}};
    };
    const auto stays_of = [](const GravitySoFar& gravity) {
        return parsed(gravity).at("stays").dump();
    };
    GravitySoFar gravity({.command = {}, .reason = "no_sites"});
    gravity.start();
    gravity.note_change(false);
    CHECK(parsed(gravity).at("reason") == "no_sites");
    CHECK(parsed(gravity).at("reason_text") == "the configuration names no table of sites");
    CHECK(parsed(gravity).at("reason_parts").is_array());
    CHECK(parsed(gravity).at("stays").empty());
    gravity.use(says("[1]"));
    CHECK(comes_true([&] { return stays_of(gravity) == "[1]"; }));
    gravity.use(says("[2]"));
    CHECK(comes_true([&] { return stays_of(gravity) == "[2]"; }));
    // The same command, after its list was changed.
    const test::TemporaryDirectory folder;
    const GravityOptions of_file{
        .command = {"/bin/cat", folder.write("answer", R"({"reason":null,"stays":[3]})").string()}};
    gravity.use(of_file);
    CHECK(comes_true([&] { return stays_of(gravity) == "[3]"; }));
    folder.write("answer", R"({"reason":null,"stays":[4]})");
    gravity.use(of_file);
    CHECK(comes_true([&] {
        const std::string stays = stays_of(gravity);
        CHECK(stays != "[]");  // The old figures stay until the new ones are there.
        return stays == "[4]";
    }));
    gravity.use({.command = {}, .reason = "no_sites"});
    CHECK(parsed(gravity).at("reason") == "no_sites");
    CHECK(stays_of(gravity) == "[]");
}

TEST_CASE("the command has the files of the survey, and the reason says why there is none") {
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
