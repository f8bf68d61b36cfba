#include "protocol/events/occupations.hpp"

#include <fstream>
#include <iterator>
#include "tests/support/catch.hpp"

#include "tests/unit/events/made_up_events.hpp"

namespace a351::events {
namespace {

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

TEST_CASE("a stop that names another site ends the stay, and its notes say so") {
    Event other = stop("09:10");
    other.details["site"] = "B";
    const auto stays = occupations_of({start("09:00", "C"), other});
    REQUIRE(stays.size() == 1);
    CHECK(stays[0].site == "C");
    CHECK(stays[0].note == "its stop names B");
    other.details["site"] = "C";
    CHECK(occupations_of({start("09:00", "C"), other})[0].note.empty());
}

TEST_CASE("what is said of a face stays with its set-up when the stay is re-timed") {
    std::vector<Event> events{
        event_of("start", "09:00", {{"site", "A"}, {"key", "k"}, {"face", "+"}}),
        event_of("setup", "09:10", {{"planned_face", "-"}}),
        event_of("setup", "09:20", {{"face", "up"}, {"planned_face", "+"}}), stop("09:30")};
    const auto expected = [&] {
        std::vector<int> faces;
        const auto stays = occupations_of(events);
        for (const auto& set_up : stays.at(0).set_ups)
            faces.push_back(set_up.face.expected().value_or(0));
        return faces;
    };
    CHECK(expected() == std::vector{1, -1, 1});
    CHECK_FALSE(occupations_of(events)[0].set_ups[2].face.entered);
    const auto retimed = [&](const char* from) {
        auto copy = events;
        copy.push_back(event_of("retime", "09:40",
                                {{"key", "k"}, {"from", std::string("2026-03-01T") + from}}));
        std::swap(copy, events);
        const auto faces = expected();
        std::swap(copy, events);
        return faces;
    };
    CHECK(retimed("08:50:00Z") == std::vector{1, -1, 1});
    CHECK(retimed("09:12:00Z") == std::vector{-1, 1});
    events[1].details["face"] = "+";
    CHECK(expected() == std::vector{1, 1, 1});  // what was entered, before the plan
    events[0].details.erase("face");
    CHECK(expected() == std::vector{0, 1, 1});
}

TEST_CASE("occupations have the times of the log, and are numbered per site in time order") {
    const auto discard = event_of("discard", "23:00");
    const auto rename = [](const char* site) {
        return event_of("rename", "23:00", {{"site", site}});
    };
    struct Case {
        const char* law;
        std::vector<Event> events;
        Lines expected;
    };
    const std::vector two{start("09:00", "A"), stop("09:10"), start("10:00", "A"), stop("10:10")};
    const auto two_and = [&](std::vector<Event> more) {
        more.insert(more.begin(), two.begin(), two.end());
        return more;
    };
    for (const auto& [law, events, expected] : {
             Case{"numbers follow the times, also of those that were logged late",
                  {start("10:00", "A"), stop("10:10"), start("11:00", "B"), stop("11:10"),
                   start("12:00", "A"), stop("12:10"), start("09:00", "A"), stop("09:10")},
                  {"A#1 09:00-09:10", "A#2 10:00-10:10", "B#1 11:00-11:10", "A#3 12:00-12:10"}},
             Case{
                 "a site is one in all forms of its characters",
                 {start("09:00", "Caf\u00E9"), stop("09:10"), start("09:20", "Cafe\u0301"),
                  stop("09:30"), start("09:40", "B"), rename("Cafe\u0301"), stop("10:00")},
                 {"Caf\u00E9#1 09:00-09:10", "Caf\u00E9#2 09:20-09:30", "Caf\u00E9#3 09:40-10:00"}},
             Case{"a start ends the occupation that is running",
                  {start("09:00", "A"), start("09:30", "B"), stop("09:40")},
                  {"A#1 09:00-09:30", "B#1 09:30-09:40"}},
             Case{"a set-up divides an occupation, events of other kinds do not",
                  {start("09:00", "A"), event_of("setup", "09:05"), event_of("fault", "09:06"),
                   event_of("setup", "09:07"), event_of("clock_step", "09:08"), stop("09:10")},
                  {"A#1 09:00-09:05 09:05-09:07 09:07-09:10"}},
             Case{"no set-up is before the start or of no length",
                  {event_of("setup", "09:05"), start("09:10", "A"), event_of("setup", "09:10"),
                   stop("09:20")},
                  {"A#1 09:10-09:20"}},
             Case{"a running occupation is left out", {start("09:00", "A")}, {}},
             Case{"one of no length is left out", {start("09:00", "A"), stop("09:00")}, {}},
             Case{"a stop alone is nothing", {stop("09:00")}, {}},
             Case{"one that ends before it starts is kept as logged, with its number",
                  {start("09:10", "A"), stop("09:00"), start("10:00", "A"), stop("10:10")},
                  {"A#1 09:10-09:00", "A#2 10:00-10:10"}},
             Case{"a discarded occupation is neither listed nor counted",
                  {start("09:00", "A"), discard, stop("09:10"), start("10:00", "A"), stop("10:10")},
                  {"A#1 10:00-10:10"}},
             Case{"discard applies to the last one", two_and({discard}), {"A#1 09:00-09:10"}},
             Case{"and then to that before", two_and({discard, discard}), {}},
             Case{"and then to none", two_and({discard, discard, discard}), {}},
             Case{"rename applies to the running one",
                  {rename("C"), start("09:00", "A"), stop("09:10"), start("10:00", "B"),
                   rename("C"), stop("10:10")},
                  {"A#1 09:00-09:10", "C#1 10:00-10:10"}},
             Case{"or otherwise to the last one",
                  two_and({rename("C")}),
                  {"A#1 09:00-09:10", "C#1 10:00-10:10"}},
             Case{"the last one is that which was entered last, also with an earlier time",
                  {start("10:00", "A"), stop("10:10"), start("09:00", "B"), stop("09:10"),
                   rename("C"), start("08:00", "D"), stop("08:10"), discard},
                  {"C#1 09:00-09:10", "A#1 10:00-10:10"}},
         }) {
        CAPTURE(law);
        CHECK(shown(events) == expected);
    }
    const auto both = occupations_of({start("09:00", "A"), start("09:30", "B"), stop("09:40")});
    CHECK_FALSE(both[0].is_stopped);
    CHECK(both[1].is_stopped);
}

TEST_CASE("notes during an occupation are joined, other notes stay only in the log") {
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

TEST_CASE("planned set-ups that are no whole number from 2 to 100 count as not given") {
    const auto planned = [](const char* text) {
        auto begin = start("09:00", "A");
        begin.details["set_ups"] = text;
        return OccupationReplay({begin}).running()->planned_set_ups;
    };
    CHECK(planned("2") == 2);
    CHECK(planned("100") == 100);
    for (const char* text : {"", "1", "101", "-20", "20.0", "20abc", " 20", "2000000000abc",
                             "2000000000", "99999999999999999999"}) {
        CAPTURE(text);
        CHECK_FALSE(planned(text));
    }
}

TEST_CASE("another sensor ends the running occupation at the last sample of the one before") {
    const auto change = [](const char* at) {
        return event_of("other_unit", at, {{"before", "A1"}, {"serial_number", "B2"}});
    };
    OccupationReplay replay({start("09:00", "A"), change("09:05"), stop("09:10")});
    REQUIRE(replay.finished().size() == 1);
    CHECK(shown({start("09:00", "A"), change("09:05"), stop("09:10")}) == Lines{"A#1 09:00-09:05"});
    CHECK(replay.finished()[0].is_stopped);
    CHECK(replay.finished()[0].note == "another sensor: B2 after A1");
    CHECK(shown({change("08:00"), start("09:00", "A"), stop("09:10")}) == Lines{"A#1 09:00-09:10"});
    // The set-up began after the last sample.
    CHECK(shown({start("09:00", "A"), event_of("setup", "09:06"), change("09:05")}) ==
          Lines{"A#1 09:00-09:06"});
    // The stay was started between the unplugging of one sensor and the first sample of the other.
    CHECK(shown({start("10:00", "A"), change("09:50"), stop("10:10")}) == Lines{"A#1 10:00-10:10"});
}

TEST_CASE(
    "only a running occupation is running, and has its number, set-ups, operator and notes so "
    "far") {
    auto begin = start("09:00", "A");
    begin.details["operator"] = "M. Ito";
    OccupationReplay replay({start("08:00", "A"), stop("08:10"), begin, event_of("setup", "09:05"),
                             event_of("note", "09:06", {{"note", "lorry"}})});
    const RunningOccupation running = replay.running().value();
    CHECK(running.site == "A");
    CHECK(running.number == 2);
    CHECK(running.operator_name == "M. Ito");
    CHECK(running.note == "lorry");
    CHECK(running.set_ups == std::vector{begin.utc, at("2026-03-01T09:05:00Z")});
    replay.take(event_of("rename", "09:07", {{"site", "B"}}));
    CHECK(replay.running()->number == 1);
    // New times move its start and give it no end.
    replay.take(event_of("retime", "09:08",
                         {{"key", "20260301T090000Z"},
                          {"from", "2026-03-01T08:55:00Z"},
                          {"to", "2026-03-01T09:07:00Z"}}));
    CHECK(replay.running()->set_ups ==
          std::vector{at("2026-03-01T08:55:00Z"), at("2026-03-01T09:05:00Z")});
    CHECK_FALSE(OccupationReplay({start("09:00", "A"), stop("09:10")}).running());
    CHECK_FALSE(OccupationReplay({start("09:00", "A"), event_of("discard", "09:05")}).running());
}

TEST_CASE("a stay has its start as key, which is never given twice") {
    OccupationReplay replay({start("09:00", "A"), stop("09:10"), event_of("discard", "09:11"),
                             start("09:00", "A"), stop("09:10")});
    CHECK(replay.finished()[0].key == "20260301T090001Z");
    CHECK(replay.discarded()[0].key == "20260301T090000Z");
    CHECK(replay.key_for(at("2026-03-01T09:00:00.7Z")) == "20260301T090002Z");
    // Neither a rename nor a new time changes it.
    replay.take(event_of("rename", "09:20", {{"key", "20260301T090001Z"}, {"site", "B"}}));
    replay.take(event_of("retime", "09:20",
                         {{"key", "20260301T090001Z"}, {"from", "2026-03-01T08:50:00Z"}}));
    CHECK(replay.finished()[0].key == "20260301T090001Z");
    CHECK(replay.finished()[0].site == "B");
    auto given = start("10:00", "C");
    given.details["key"] = "20260301T095959Z";
    replay.take(given);
    CHECK(replay.running()->key == "20260301T095959Z");
    replay.take(given);  // the key is taken, so that of the start is given
    CHECK(replay.running()->key == "20260301T100000Z");
}

TEST_CASE("a change applies to the stay that its key names, and to no other") {
    const std::map<std::string, std::string> of_a{{"key", "20260301T090000Z"}};
    const auto with = [](std::map<std::string, std::string> details, const std::string& key,
                         const std::string& value) {
        details[key] = value;
        return details;
    };
    std::vector events{start("09:00", "A"), event_of("setup", "09:05"),
                       stop("09:10"),       start("10:00", "B"),
                       stop("10:10"),       start("11:00", "C")};
    const auto then = [&](const char* type, const std::map<std::string, std::string>& details) {
        events.push_back(event_of(type, "11:05", details));
        return shown(events);
    };
    CHECK(then("discard", of_a) == Lines{"B#1 10:00-10:10"});
    CHECK(then("restore", of_a) == Lines{"A#1 09:00-09:05 09:05-09:10", "B#1 10:00-10:10"});
    CHECK(then("rename", with(of_a, "site", "B")) ==
          Lines{"B#1 09:00-09:05 09:05-09:10", "B#2 10:00-10:10"});
    CHECK(then("retime", with(of_a, "to", "2026-03-01T09:20:00Z")) ==
          Lines{"B#1 09:00-09:05 09:05-09:20", "B#2 10:00-10:10"});
    CHECK(then("retime", with(of_a, "from", "2026-03-01T09:07:00Z")) ==
          Lines{"B#1 09:07-09:20", "B#2 10:00-10:10"});
    CHECK(then("retime", with(of_a, "from", "2026-03-01T08:55:00Z")) ==
          Lines{"B#1 08:55-09:05 09:05-09:20", "B#2 10:00-10:10"});
    CHECK(then("note", with(of_a, "note", "lorry")).size() == 2);
    CHECK(occupations_of(events)[0].note == "lorry");
    const Lines before = shown(events);
    for (const char* type : {"discard", "restore", "resume", "rename", "retime", "note"}) {
        CAPTURE(type);
        CHECK(then(type, {{"key", "20260301T080000Z"}, {"site", "X"}, {"note", "x"}}) == before);
    }
    CHECK(then("resume", of_a) == before);  // another stay runs
}

TEST_CASE("a stay is resumed as if it had not been stopped") {
    std::vector events{start("09:00", "A"), event_of("setup", "09:05"), stop("09:10"),
                       event_of("resume", "09:12", {{"key", "20260301T090000Z"}})};
    CHECK(OccupationReplay(events).running()->key == "20260301T090000Z");
    CHECK(shown(events).empty());
    events.push_back(stop("09:20"));
    CHECK(shown(events) == Lines{"A#1 09:00-09:05 09:05-09:20"});
    // A start that was moved stays so.
    CHECK(shown({start("09:00", "A"), stop("09:10"),
                 event_of("retime", "09:11", {{"key", "20260301T090000Z"}, {"from", "2026-03-01T09:03:00Z"}}),
                 event_of("resume", "09:12", {{"key", "20260301T090000Z"}}), stop("09:20")}) ==
          Lines{"A#1 09:03-09:20"});
    // A discarded running stay has ended; it can be restored and resumed.
    events.insert(events.end(), {start("10:00", "B"), event_of("discard", "10:05"),
                                 event_of("restore", "10:06", {{"key", "20260301T100000Z"}})});
    CHECK(shown(events).back() == "B#1 10:00-10:05");
}

TEST_CASE("the reference log has the occupations worked out by hand") {
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
    CHECK(OccupationReplay(log.events).running()->site == "No.9");
}

}  // namespace a351::events
