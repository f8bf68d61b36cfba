#include "sim/line/run_faults.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/sim/line/fault_rig.hpp"

using namespace a351::sim;
using namespace a351;
using namespace a351::sim::line;
using namespace a351::sim::truth;

namespace {

std::vector<std::uint16_t> counts_of(const Rig& rig, std::uint16_t run) {
    std::vector<std::uint16_t> counts;
    for (const truth::Record& record : rig.truth) {
        if (record.sampling_run == run) counts.push_back(record.values.count);
    }
    return counts;
}

void order(Rig& rig, std::string_view words) {
    rig.faults.apply(parse_fault(words, rig.rules), rig.now);
}

}  // namespace

TEST_CASE("error flags are in as many frames as requested") {
    Rig rig(fault("error_flags", "at_frame = 100\ncount = 7\ndiag_stat = 0x20"));
    const Decoded decoded = check_report(rig);
    for (std::size_t i = 0; i < decoded.frames.size(); ++i) {
        REQUIRE((decoded.frames[i].flag & wire::kFlagError) == (i > 100 && i <= 107 ? 1 : 0));
    }
    CHECK(rig.line.report().frames_flagged == 7);
}

TEST_CASE("a counter fault outside sampling begins with the next frame") {
    using Counts = std::vector<std::uint16_t>;
    // After a reset the second frame shows the COUNT of the first.
    const bool is_stuck = GENERATE(true, false);
    Rig rig("");
    rig.run_to(UtcTime(2s));
    rig.bench.send({"83 02"});
    rig.run_to(UtcTime(3s));
    order(rig, is_stuck ? "counter_stuck count=3" : "counter_reset");
    rig.bench.send({"83 01"});
    check_report(rig);
    const auto counts = counts_of(rig, 2);
    REQUIRE(counts.size() > 1000);
    CHECK(Counts(counts.begin(), counts.begin() + 6) ==
          (is_stuck ? Counts{80, 80, 80, 80, 400, 480} : Counts{80, 80, 160, 240, 320, 400}));
    CHECK(rig.line.report().frames_repeated == (is_stuck ? 3 : 1));
    CHECK(rig.line.report().frames_misplaced == 0);
}

TEST_CASE("the end of sampling ends a stuck counter") {
    const bool is_seen = GENERATE(false, true);
    Rig rig(fault("counter_stuck", "at_frame = 50\ncount = 1000"));
    rig.run_to(UtcTime(5s));
    rig.bench.send({"83 02"});
    if (is_seen) rig.run_to(UtcTime(6s));
    rig.bench.send({"83 01"});
    check_report(rig);
    const auto counts = counts_of(rig, 2);
    REQUIRE(counts.size() > 500);
    for (std::size_t i = 0; i < counts.size(); ++i) {
        REQUIRE(counts[i] == static_cast<std::uint16_t>(80 * (i + 1)));
    }
}

TEST_CASE("a counter jump that is overtaken by the end of sampling happens in the next run") {
    Rig rig(fault("counter_jump", "at_frame = 50\nticks = 7") + fault("stop", "at_frame = 50"));
    rig.run_to(UtcTime(3s));
    rig.bench.send({"83 01"});
    check_report(rig);
    CHECK(counts_of(rig, 2).at(0) == 80);
    // The jump waited for a frame that has a successor.
    CHECK(counts_of(rig, 2).at(1) == 80 + 87);
    CHECK(rig.line.report().frames_misplaced == 1);
}

TEST_CASE("error flags of a start-up are not counted as requested ones") {
    Rig rig(fault("error_flags", "at_frame = 50\ncount = 1000\ndiag_stat = 0x20") +
            fault("reset", "at_frame = 80") + fault("failing_tests", "at_s = 4\ndiag_stat = 0x20") +
            fault("reset", "at_s = 5"));
    rig.run_to(UtcTime(6s));
    rig.bench.now += 1s;
    rig.bench.machine.pass_time(rig.bench.now);
    rig.bench.start_logging();
    check_report(rig);
    CHECK(rig.made(FaultKind::error_flags) == 30);
    CHECK(rig.line.report().frames_flagged > 1000);  // Genuine ones.
}

TEST_CASE("after the host has read DIAG_STAT, later error flags are not counted for the fault") {
    Rig rig(fault("error_flags", "at_frame = 50\ncount = 1000\ndiag_stat = 0x20"));
    rig.run_to(UtcTime(3s));
    const auto flagged = rig.line.report().frames_flagged;
    CHECK(rig.bench.send({"04 00"}) == "04 00 20 0D");
    rig.run_to(UtcTime(4s));
    rig.bench.machine.raise_diagnostics(0x20);
    check_report(rig);
    CHECK(rig.made(FaultKind::error_flags) == flagged);
    CHECK(rig.line.report().frames_flagged > flagged + 1000);
}

TEST_CASE("error flags that no frame carries are not counted") {
    Rig rig(fault("error_flags", "at_frame = 50\ncount = 20"));
    rig.bench.send({"83 02", "FE 01", "8D 47", "FE 00", "83 01"});  // Without FLAG.
    rig.run_to(UtcTime(10s));
    CHECK(rig.line.report().frames_sent > 400);
    CHECK(rig.line.report().frames_flagged == 0);
    CHECK(rig.made(FaultKind::error_flags) == 0);
}
