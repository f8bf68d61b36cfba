#include "daemon/status/status_log.hpp"

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <sstream>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::daemon::source;
using namespace a351::daemon::status;
using std::chrono::seconds;

namespace {

struct Fixture {
    std::ostringstream out;
    std::shared_ptr<spdlog::logger> log = std::make_shared<spdlog::logger>(
        "test", std::make_shared<spdlog::sinks::ostream_sink_st>(out));
    StatusLog status_log{log};
    StatusLog::Instant start{};

    Fixture() { log->set_pattern("%v"); }

    std::string said(const Status& status, int second) {
        out.str("");
        status_log.note(status, start + seconds(second));
        return out.str();
    }
};

}  // namespace

TEST_CASE_METHOD(
    Fixture, "a trouble is logged when it begins, once a minute with its count, and when it ends") {
    Status bad;
    bad.reasons = {"no disk"};
    CHECK(said(bad, 0) == "no disk\n");
    CHECK(said(bad, 1).empty());
    CHECK(said(bad, 59).empty());
    CHECK(said(bad, 60) == "no disk (seen 4 times)\n");
    CHECK(said(bad, 61).empty());
    CHECK(said(Status(), 62) == "resolved: no disk\n");
    CHECK(said(Status(), 63).empty());
}

TEST_CASE_METHOD(Fixture, "a reason that names another file each time is logged as one") {
    Status status;
    const auto refuse = [&](int segment) {
        status.reasons = {"journal: open data/journal/0000000" + std::to_string(segment) +
                          ".a351j: Read-only file system"};
    };
    refuse(1);
    CHECK_FALSE(said(status, 0).empty());
    for (int second = 1; second < 60; ++second) {
        refuse(second % 10);
        CHECK(said(status, second).empty());
    }
    CHECK(said(Status(), 60) ==
          "resolved: journal: open data/journal/00000009.a351j: Read-only file system\n");
}

TEST_CASE_METHOD(Fixture, "a rising counter is logged with its increase, at most once a minute") {
    Status status;
    CHECK(said(status, 0).empty());
    status.counters.gaps = 2;
    CHECK(said(status, 1) == "gaps: 2 more, 2 in total\n");
    status.counters.gaps = 3;
    CHECK(said(status, 2).empty());
    status.counters.gaps = 7;
    CHECK(said(status, 61) == "gaps: 5 more, 7 in total\n");
}

TEST_CASE_METHOD(Fixture,
                 "the state of the oven is logged when it changes, and its failed polls by kind") {
    Status status;
    CHECK(said(status, 0).empty());
    OvenLinkStatus& oven = status.oven.emplace();
    oven.state = OvenLinkStatus::State::answering;
    oven.trouble = "";
    oven.port = "/dev/pts/5, 9600 baud 8N2";
    oven.polls = {1};  // Answered, timed out.
    CHECK(said(status, 1) == "oven: answering (/dev/pts/5, 9600 baud 8N2)\n");
    oven.polls = {2, 3};
    CHECK(said(status, 2) == "oven polls timed_out: 3 more, 3 in total\n");
    oven.state = OvenLinkStatus::State::silent;
    oven.trouble = "no answer in time";
    CHECK(said(status, 3) == "oven: silent (no answer in time)\n");
    CHECK(said(status, 4).empty());
}

TEST_CASE_METHOD(Fixture,
                 "the state of the disk reserve is logged when it changes, with the reason") {
    Status status;
    status.disk_reserve = "present";
    CHECK(said(status, 0) == "reserve for a full disk: present\n");
    CHECK(said(status, 1).empty());
    status.disk_reserve = "unavailable";
    status.disk_reserve_trouble = "allocate: not supported";
    CHECK(said(status, 2) == "reserve for a full disk: unavailable: allocate: not supported\n");
}
