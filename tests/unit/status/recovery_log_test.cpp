#include "daemon/status/recovery_log.hpp"

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <sstream>
#include "daemon/status/status.hpp"
#include "tests/support/catch.hpp"

using namespace a351;

TEST_CASE("the log of a recovery names every damage, with its file and offset") {
    std::ostringstream out;
    spdlog::logger log("test", std::make_shared<spdlog::sinks::ostream_sink_st>(out));
    log.set_pattern("%l: %v");
    archive::RecoveryReport report;
    report.records_added = 3;
    report.records_confirmed = 5;
    SECTION("without damage it is one line") {
        daemon::status::log_recovery(log, report);
        CHECK(out.str() ==
              "info: recovery: 3 records added to the archive, 5 were already there\n");
    }
    SECTION("what is lost is an error, what is cut a warning") {
        report.journal = journal::Damage{"2.a351j", 100, 7, "torn"};
        report.damage = {{"1.a351j", 50, 13, "checksum"}};
        report.archive = {{"day.D", 512, 9}};
        report.chunks_lost = 2;
        report.records_conflicting = 1;
        daemon::status::log_recovery(log, report);
        CHECK(
            out.str() ==
            "warning: recovery: 7 bytes removed from 2.a351j from offset 100 on: torn\n"
            "error: recovery: 13 bytes of 1.a351j at offset 50 are damaged and skipped: checksum\n"
            "warning: recovery: 9 bytes removed from day.D from offset 512 on\n"
            "info: recovery: 3 records added to the archive, 5 were already there\n"
            "error: recovery: 2 chunks of the journal could not be processed and are missing "
            "from the archive\n"
            "error: recovery: 1 records of the archive differ from the journal; those of the "
            "archive are kept\n");
    }
}

TEST_CASE("the service manager shows the state of the link and the first reason") {
    daemon::status::Status status;
    status.link_state = "sampling";
    CHECK(daemon::status::brief(status) == "sampling");
    status.warn("the disk is nearly full");
    status.warn("the oven does not answer");
    CHECK(daemon::status::brief(status) == "sampling; the disk is nearly full");
}
