#include "protocol/events/event_log.hpp"

#include <stdexcept>
#include "tests/support/catch.hpp"

#include "tests/support/file_bytes.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/events/made_up_events.hpp"
#include "tests/unit/files/forwarding_files.hpp"

using namespace a351::files;
using namespace a351::journal;

namespace a351::events {

TEST_CASE("an event is read back from its line") {
    Event event = start("09:30", "No.5");
    event.index = 7;
    event.details["operator"] = "M";
    // The line of event-format.md.
    CHECK(to_json(event) == R"({"type":"start","utc":"2026-03-01T09:30:00.000000000Z","index":7,)"
                            R"("operator":"M","site":"No.5"})");
    event.utc = at("2026-03-01T09:30:00.123456789Z");
    event.session = SessionId::from_hex("000102030405060708090a0b0c0d0e0f");
    event.index = 123'456'789'012;
    event.details["note"] = "wind, \"rain\"\n\xE3\x81\x82 <b>";
    const auto json = to_json(event);
    CHECK(json.find('\n') == std::string::npos);
    const auto read = parse_event(json);
    REQUIRE(read);
    CHECK(read->type == event.type);
    CHECK(read->utc == event.utc);
    CHECK(read->session == event.session);
    CHECK(read->index == event.index);
    CHECK(read->details == event.details);
    event.details["utc"] = "now";  // the name of a field of every event
    CHECK_THROWS_AS(to_json(event), std::invalid_argument);
}

TEST_CASE("a line with a missing field or a field of another type is not an event") {
    const char* line = GENERATE(
        "", "null", "[]", "{", R"({"type":"start"})", R"({"utc":"2026-03-01T09:30:00Z"})",
        R"({"type":"","utc":"2026-03-01T09:30:00Z"})", R"({"type":1,"utc":"2026-03-01T09:30:00Z"})",
        R"({"type":"start","utc":"2026-02-30T09:30:00Z"})",
        R"({"type":"start","utc":"2026-03-01T09:30:00Z","index":"7"})",
        R"({"type":"start","utc":"2026-03-01T09:30:00Z","index":7.5})",
        R"({"type":"start","utc":"2026-03-01T09:30:00Z","session":"12"})",
        R"({"type":"start","utc":"2026-03-01T09:30:00Z","site":5})",
        R"({"type":"start","utc":"2026-03-01T09:30:00Z"} x)");
    CHECK_FALSE(parse_event(line));
}

TEST_CASE("events are written to the file of their month and read back in order") {
    const test::TemporaryDirectory directory;
    const auto events = directory.path() / "events";
    for (const char* time :
         {"2026-03-31T23:59:59Z", "2026-04-01T00:00:00Z", "2026-03-01T00:00:00Z"}) {
        append_event(posix_files(), events, {"note", at(time), {}, {}, {{"note", time}}});
    }
    CHECK(std::filesystem::exists(events / "2026-03.jsonl"));
    CHECK(std::filesystem::exists(events / "2026-04.jsonl"));
    test::write_bytes(events / "2026-03.jsonl.bak", test::bytes_of("not read"));
    const auto log = read_events(events);
    CHECK(log.damage.empty());
    REQUIRE(log.events.size() == 3);
    CHECK(log.events[0].utc == at("2026-03-31T23:59:59Z"));
    CHECK(log.events[1].utc == at("2026-03-01T00:00:00Z"));
    CHECK(log.events[2].utc == at("2026-04-01T00:00:00Z"));
    CHECK(read_events(directory.path() / "absent").events.empty());
}

TEST_CASE("lines that a merged copy has twice count once") {
    test::TemporaryDirectory directory;
    const auto line = [](const char* type, const char* minute) {
        return std::string("{\"type\":\"") + type + "\",\"utc\":\"2026-03-01T09:" + minute +
               ":00Z\"}\n";
    };
    const auto types = [&](const std::string& log) {
        test::write_bytes(directory.path() / "2026-03.jsonl", test::bytes_of(log));
        std::string all;
        for (const Event& event : read_events(directory.path()).events) all += event.type + " ";
        return all;
    };
    const std::string morning = line("start", "00") + line("stop", "10") + line("discard", "10") +
                                line("restore", "10") + line("discard", "10");
    const std::string expected = "start stop discard restore discard ";
    CHECK(types(morning) == expected);
    CHECK(types(morning + morning) == expected);
    CHECK(types(morning + morning + line("start", "20")) == expected + "start ");
    // Changes before the first start, of a stay of the month before.
    const std::string change = line("discard", "00") + line("start", "00") + line("restore", "00");
    CHECK(types(change + change + change) == "discard start restore ");
    CHECK(types(change + line("discard", "00")) == "discard start restore discard ");
    CHECK(types(change + change + line("discard", "00")) == "discard start restore discard ");
    CHECK(types(line("start", "00") + line("start", "00") + line("start", "01")) == "start start ");
}

TEST_CASE("a line torn at any byte is reported and does not damage the next one") {
    const test::TemporaryDirectory directory;
    const auto file = directory.path() / "2026-03.jsonl";
    const std::string first = to_json(start("09:00", "No.1")) + "\n";
    const std::string second = to_json(stop("09:10")) + "\n";
    for (std::size_t size = 0; size <= second.size(); ++size) {
        test::write_bytes(file, test::bytes_of(first + second.substr(0, size)));
        append_event(posix_files(), directory.path(), start("09:20", "No.2"));
        const auto log = read_events(directory.path());
        const bool is_whole = size + 1 >= second.size();  // The newline itself may be lost.
        const bool is_torn = size > 0 && !is_whole;
        REQUIRE(log.events.size() == (is_whole ? 3 : 2));
        REQUIRE(log.events.back().details.at("site") == "No.2");
        REQUIRE(log.damage.size() == (is_torn ? 1 : 0));
        if (is_torn) CHECK(log.damage[0].line == 2);
    }
}

TEST_CASE(
    "each event syncs the directory, because an earlier program may have been killed before") {
    struct CountingFiles : test::ForwardingFiles {
        void sync_directory(const std::filesystem::path&) override { ++syncs; }
        int syncs = 0;
    };
    const test::TemporaryDirectory directory;
    CountingFiles files;
    append_event(files, directory.path(), start("09:00", "No.1"));
    append_event(files, directory.path(), stop("09:10"));
    CHECK(files.syncs == 2);
}

}  // namespace a351::events
