#include "protocol/events/event_log.hpp"

#include <fstream>
#include <iterator>
#include <stdexcept>
#include "tests/support/catch.hpp"

#include "tests/support/file_bytes.hpp"
#include "tests/support/temporary_directory.hpp"

namespace a351::record {
namespace {

UtcTime at(const std::string& time) { return *parse_rfc3339(time); }

Event event_of(std::string type, const std::string& time_of_day,
               std::map<std::string, std::string> details = {}) {
    return {std::move(type), at("2026-03-01T" + time_of_day + ":00Z"), std::nullopt, std::nullopt,
            std::move(details)};
}

Event start(const std::string& time_of_day, const std::string& site) {
    return event_of("start", time_of_day, {{"site", site}});
}
Event stop(const std::string& time_of_day) { return event_of("stop", time_of_day); }

/// Returns "site#number hh:mm-hh:mm ..." for each occupation.
std::vector<std::string> shown(const std::vector<Event>& events) {
    std::vector<std::string> lines;
    for (const auto& occupation : occupations_of(events)) {
        std::string line = occupation.site;
        line.append("#").append(std::to_string(occupation.number));
        for (const auto& set_up : occupation.set_ups) {
            line += " " + to_rfc3339(set_up.start).substr(11, 5) + "-" +
                    to_rfc3339(set_up.end).substr(11, 5);
        }
        lines.push_back(line);
    }
    return lines;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("an event is read back from its line", "[record][event_log]") {
    Event event = start("09:30", "No.5");
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
}

TEST_CASE("the line of an event is written as the format page shows it", "[record][event_log]") {
    Event event = start("09:30", "No.5");
    event.index = 7;
    event.details["operator"] = "M";
    CHECK(to_json(event) == R"({"type":"start","utc":"2026-03-01T09:30:00.000000000Z","index":7,)"
                            R"("operator":"M","site":"No.5"})");
}

TEST_CASE("a line with a missing field or a field of another type is not an event",
          "[record][event_log]") {
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

TEST_CASE("a detail with the name of a field is refused", "[record][event_log]") {
    Event event = start("09:30", "No.5");
    event.details["utc"] = "now";
    CHECK_THROWS_AS(to_json(event), std::invalid_argument);
}

TEST_CASE("events are written to the file of their month and read back in order",
          "[record][event_log]") {
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

TEST_CASE("a line torn at any byte is reported and does not damage the next one",
          "[record][event_log]") {
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

TEST_CASE("start and stop make an occupation", "[record][event_log]") {
    CHECK(shown({start("09:00", "A"), stop("09:10")}) == Lines{"A#1 09:00-09:10"});
}

TEST_CASE("occupations are numbered per site in time order", "[record][event_log]") {
    CHECK(shown({start("10:00", "A"), stop("10:10"), start("11:00", "B"), stop("11:10"),
                 start("12:00", "A"), stop("12:10"),
                 // Logged last, with a time before all others.
                 start("09:00", "A"), stop("09:10")}) ==
          Lines{"A#1 09:00-09:10", "A#2 10:00-10:10", "B#1 11:00-11:10", "A#3 12:00-12:10"});
}

TEST_CASE("a start while another occupation is running ends that occupation",
          "[record][event_log]") {
    CHECK(shown({start("09:00", "A"), start("09:30", "B"), stop("09:40")}) ==
          Lines{"A#1 09:00-09:30", "B#1 09:30-09:40"});
}

TEST_CASE("a set-up event divides an occupation", "[record][event_log]") {
    CHECK(shown({start("09:00", "A"), event_of("setup", "09:05"), event_of("setup", "09:07"),
                 stop("09:10")}) == Lines{"A#1 09:00-09:05 09:05-09:07 09:07-09:10"});
    CHECK(shown({event_of("setup", "09:05"), start("09:10", "A"), event_of("setup", "09:10"),
                 stop("09:20")}) == Lines{"A#1 09:10-09:20"});
}

TEST_CASE("a running occupation and an occupation of no length are left out",
          "[record][event_log]") {
    CHECK(shown({start("09:00", "A")}).empty());
    CHECK(shown({start("09:00", "A"), stop("09:00")}).empty());
    CHECK(shown({stop("09:00")}).empty());
}

TEST_CASE("an occupation that ends before it starts is kept as logged, with its number",
          "[record][event_log]") {
    CHECK(shown({start("09:10", "A"), stop("09:00"), start("10:00", "A"), stop("10:10")}) ==
          Lines{"A#1 09:10-09:00", "A#2 10:00-10:10"});
}

TEST_CASE("a discarded occupation is neither listed nor counted", "[record][event_log]") {
    const auto discard = event_of("discard", "23:00");
    CHECK(shown({start("09:00", "A"), discard, stop("09:10"), start("10:00", "A"),
                 stop("10:10")}) == Lines{"A#1 10:00-10:10"});
    const std::vector two{start("09:00", "A"), stop("09:10"), start("10:00", "A"), stop("10:10")};
    auto events = two;
    events.push_back(discard);
    CHECK(shown(events) == Lines{"A#1 09:00-09:10"});
    events.push_back(discard);
    CHECK(shown(events).empty());
    events.push_back(discard);
    CHECK(shown(events).empty());
}

TEST_CASE("a rename applies to the running occupation, or otherwise to the last one",
          "[record][event_log]") {
    const auto rename = event_of("rename", "23:00", {{"site", "C"}});
    CHECK(shown({rename, start("09:00", "A"), stop("09:10"), start("10:00", "B"), rename,
                 stop("10:10")}) == Lines{"A#1 09:00-09:10", "C#1 10:00-10:10"});
    CHECK(shown({start("09:00", "A"), stop("09:10"), start("10:00", "B"), stop("10:10"), rename}) ==
          Lines{"A#1 09:00-09:10", "C#1 10:00-10:10"});
}

TEST_CASE("notes during an occupation are joined, other notes stay only in the log",
          "[record][event_log]") {
    const auto note = [](const char* time, const char* text) {
        return event_of("note", time, {{"note", text}});
    };
    auto begin = start("09:00", "A");
    begin.details["note"] = "wind";
    auto end = stop("09:10");
    end.details["note"] = "calm";
    const auto occupations = occupations_of({note("08:00", "packed"), begin, note("09:05", "lorry"),
                                             end, note("09:30", "on the road")});
    REQUIRE(occupations.size() == 1);
    CHECK(occupations[0].note == "wind; lorry; calm");
}

TEST_CASE("events of other kinds change no occupation", "[record][event_log]") {
    CHECK(shown({start("09:00", "A"), event_of("fault", "09:05"), event_of("clock_step", "09:06"),
                 stop("09:10")}) == Lines{"A#1 09:00-09:10"});
}

TEST_CASE("an occupation without a stop is reported as running", "[record][event_log]") {
    CHECK(running_site({start("09:00", "A"), stop("09:10"), start("09:20", "B")}) == "B");
    CHECK_FALSE(running_site({start("09:00", "A"), stop("09:10")}).has_value());
    CHECK_FALSE(running_site({start("09:00", "A"), event_of("discard", "09:05")}).has_value());
}

TEST_CASE("the reference log has the occupations worked out by hand", "[record][event_log]") {
    const std::filesystem::path golden = A351_GOLDEN "/events";
    const EventLog log = read_events(golden);
    CHECK(log.events.size() == 16);
    REQUIRE(log.damage.size() == 1);
    CHECK(log.damage[0].line == 9);
    std::string rows = "site,number,setup,start_utc,end_utc,note\n";
    for (const Occupation& occupation : occupations_of(log.events)) {
        int number = 0;
        for (const auto& set_up : occupation.set_ups) {
            rows += occupation.site + ',' + std::to_string(occupation.number) + ',' +
                    std::to_string(++number) + ',' + to_rfc3339(set_up.start, 9) + ',' +
                    to_rfc3339(set_up.end, 9) + ',' + occupation.note + '\n';
        }
    }
    std::ifstream expected(golden / "occupations.csv");
    CHECK(rows == std::string(std::istreambuf_iterator<char>(expected), {}));
    CHECK(running_site(log.events) == "No.9");
}

}  // namespace a351::record
