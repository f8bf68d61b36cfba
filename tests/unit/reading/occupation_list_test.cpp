#include "corrector/reading/occupation_list.hpp"

#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::corrector::reading;

namespace {

const std::vector<text::Site> kListedSites{
    {"A", Degrees(140.0), Degrees(36.0), Metres(10.0), MilliGal(979900.0)},
    {"B", Degrees(140.1), Degrees(36.1), Metres(20.0), std::nullopt}};
const std::string kListHeader = "site,occupation,start_utc,end_utc,used,note\n";

OccupationList read(const std::string& rows) {
    const test::TemporaryDirectory folder;
    const auto file = folder.write("occupations.csv", kListHeader + rows);
    return drop_invalid_occupations(read_occupation_table(file, kListedSites), kListedSites, file);
}

}  // namespace

TEST_CASE("occupations are sorted by time, with several set-ups of one stay") {
    const auto list = read(
        "B,1,2020-01-01T02:00:00Z,2020-01-01T02:12:00Z,0,knocked\n"
        "A,1,2020-01-01T00:00:00,2020-01-01T00:06:00,1,\n"
        "A,1,2020-01-01T00:07:00Z,2020-01-01T00:13:00Z,,second set-up\n");
    REQUIRE(list.windows.size() == 3);
    CHECK(list.windows[0].site == "A");
    CHECK(list.windows[1].occupation == 1);
    CHECK_FALSE(list.windows[1].is_flagged);
    CHECK(list.windows[2].is_flagged);
    CHECK(list.windows[2].end - list.windows[2].start == std::chrono::minutes(12));
}

TEST_CASE("a table of occupations can say the faces of its set-ups") {
    const test::TemporaryDirectory folder;
    const std::string head = "site,occupation,start_utc,end_utc,face\n",
                      row = "A,1,2020-01-01T00:00:00Z,2020-01-01T00:06:00Z,";
    const auto face = [&](const std::string& cell) {
        return read_occupation_table(folder.write("faces.csv", head + row + cell + "\n"),
                                     kListedSites)
            .windows.at(0)
            .face.entered;
    };
    CHECK(face("+") == 1);
    CHECK(face("-") == -1);
    CHECK_FALSE(face(""));
    CHECK_THROWS_WITH(face("down"), ContainsSubstring(":2: face = down: not a face; allowed: +, - "
                                                      "or empty"));
}

TEST_CASE("a bad table of occupations is refused with line, column and value") {
    const auto [rows, message] = GENERATE(table<std::string, std::string>({
        {"C,1,2020-01-01T00:00:00Z,2020-01-01T00:06:00Z,1,\n", ":2: site = C: unknown"},
        {"A,0,2020-01-01T00:00:00Z,2020-01-01T00:06:00Z,1,\n", "occupation = 0"},
        {"A,1,noon,2020-01-01T00:06:00Z,1,\n", "start_utc = noon"},
        {"A,1,2020-01-01T00:00:00Z,2020-01-01T00:06:00Z,yes,\n", "used = yes"},
        {"A,1,2020-01-01T00:06:00Z,2020-01-01T00:06:00Z,1,\n",
         "no occupation; A (1) at 2020-01-01T00:06:00Z is left out: ends before it starts"},
        {"", "no occupation"},
    }));
    CAPTURE(rows);
    CHECK_THROWS_WITH(read(rows), ContainsSubstring(message));
    CHECK_THROWS_AS(read(rows), InputError);
}

TEST_CASE("a mistake in the field excludes only its own occupation, which is reported") {
    const test::TemporaryDirectory folder;
    const auto file =
        folder.write("2020-01.jsonl",
                     "{\"type\":\"start\",\"utc\":\"2020-01-01T00:00:00Z\",\"site\":\"A\"}\n"
                     "{\"type\":\"stop\",\"utc\":\"2020-01-01T00:10:00Z\"}\n"
                     "{\"type\":\"start\",\"utc\":\"2020-01-01T01:00:00Z\",\"site\":\"AA\"}\n"
                     "{\"type\":\"stop\",\"utc\":\"2020-01-01T01:10:00Z\"}\n"
                     "{\"type\":\"start\",\"utc\":\"2020-01-01T02:00:00Z\",\"site\":\"B\"}\n");
    const auto list =
        drop_invalid_occupations(read_logged_occupations(file.parent_path()), kListedSites, file);
    REQUIRE(list.windows.size() == 2);
    CHECK(list.windows[0].site == "A");
    CHECK_FALSE(list.windows[0].is_last);
    CHECK(list.windows[1].site == "B");
    CHECK(list.windows[1].is_last);
    CHECK(list.windows[1].end - list.windows[1].start == std::chrono::hours(6));
    REQUIRE(list.warnings.size() == 2);
    CHECK(list.warnings[0] ==
          "B (1) at 2020-01-01T02:00:00Z has no stop: it lasts until the end of the record, six "
          "hours at most");
    CHECK(list.warnings[1] ==
          "AA (1) at 2020-01-01T01:00:00Z is left out: not in the table of sites");
    REQUIRE(list.left_out.size() == 1);
    CHECK(list.left_out[0].site == "AA");
}

TEST_CASE("the last day of a log of several days is taken, or the requested time") {
    const test::TemporaryDirectory folder;
    std::string log;
    // On the first day the last stop was forgotten, so that the occupation lasts to the next
    // morning.
    for (const auto& [type, utc] :
         std::vector<std::pair<std::string, std::string>>{{"start", "2020-01-01T08:00:00Z"},
                                                          {"stop", "2020-01-01T08:10:00Z"},
                                                          {"start", "2020-01-01T13:59:59Z"},
                                                          {"start", "2020-01-02T08:00:00Z"},
                                                          {"stop", "2020-01-02T08:10:00Z"},
                                                          {"start", "2020-01-02T13:59:59Z"},
                                                          {"stop", "2020-01-02T14:10:00Z"}})
        log += R"({"type":")" + type + R"(","utc":")" + utc + R"(","site":"A"})" + "\n";
    const auto events = folder.write("2020-01.jsonl", log).parent_path();
    const auto at = [](const char* utc) { return parse_rfc3339(utc).value(); };

    const auto last = read_logged_occupations(events);
    REQUIRE(last.windows.size() == 2);
    CHECK(last.windows[0].start == at("2020-01-02T08:00:00Z"));
    CHECK(last.windows[0].occupation == 3);
    CHECK(last.windows[0].key == "20200102T080000Z");
    REQUIRE(last.warnings.size() == 1);
    CHECK(last.warnings[0] ==
          events.string() +
              ": only the last day is used, from 2020-01-02T08:00:00Z on; occupations "
              "of earlier days: 2; use from_utc and to_utc to choose others");

    const auto first = read_logged_occupations(events, {}, at("2020-01-02T08:00:00Z"));
    REQUIRE(first.windows.size() == 2);
    CHECK(first.windows[1].start == at("2020-01-01T13:59:59Z"));
    REQUIRE(first.warnings.size() == 1);
    CHECK_THAT(first.warnings[0], ContainsSubstring("lasts until the next start"));

    const auto all = read_logged_occupations(events, at("2020-01-01T08:00:00Z"));
    CHECK(all.windows.size() == 4);
    CHECK_THROWS_WITH(
        read_logged_occupations(events, at("2020-01-03T00:00:00Z"), at("2020-01-04T00:00:00Z")),
        EndsWith(": no occupation starts from 2020-01-03T00:00:00Z on and before "
                 "2020-01-04T00:00:00Z; allowed: a time that includes a start; the first is at "
                 "2020-01-01T08:00:00Z, the last at 2020-01-02T13:59:59Z"));
}

TEST_CASE("an end typed too late excludes its own occupation, not those it overlaps") {
    const auto list = read(
        "A,1,2020-01-01T00:00:00Z,2020-01-01T05:06:00Z,1,\n"
        "B,1,2020-01-01T01:00:00Z,2020-01-01T01:06:00Z,1,\n"
        "A,2,2020-01-01T02:00:00Z,2020-01-01T02:06:00Z,1,\n"
        "B,2,2020-01-01T02:06:00Z,2020-01-01T02:12:00Z,1,\n");
    CHECK(list.windows.size() == 3);
    REQUIRE(list.warnings.size() == 1);
    CHECK(list.warnings[0] ==
          "A (1) at 2020-01-01T00:00:00Z is left out: overlaps another, "
          "B (1) at 2020-01-01T01:00:00Z");
}

TEST_CASE(
    "two occupations that overlap each other are both left out, swapped times exclude only one") {
    const auto list = read(
        "A,1,2020-01-01T00:00:00Z,2020-01-01T00:06:00Z,1,\n"
        "B,1,2020-01-01T00:05:00Z,2020-01-01T00:11:00Z,1,\n"
        "A,2,2020-01-01T02:06:00Z,2020-01-01T02:00:00Z,1,\n"
        "B,2,2020-01-01T03:00:00Z,2020-01-01T03:06:00Z,1,\n");
    REQUIRE(list.windows.size() == 1);
    CHECK(list.windows[0].occupation == 2);
    REQUIRE(list.left_out.size() == 3);
    CHECK(list.left_out[0].reason == "ends before it starts");
    CHECK(list.left_out[1].reason == "overlaps another");
    CHECK(list.left_out[2].site == "B");
}

TEST_CASE("a set-up of a running stay counts when the journal has samples of it") {
    const test::TemporaryDirectory folder;
    std::string log = R"({"type":"start","utc":"2020-01-01T08:00:00Z","site":"A"})"
                      "\n";
    const auto until = [&](const char* utc) {
        const auto events = folder.write("2020-01.jsonl", log).parent_path();
        return read_logged_occupations(events, {}, {}, parse_rfc3339(utc));
    };
    const auto none = until("2020-01-01T08:00:00Z");
    CHECK(none.windows.empty());
    CHECK_FALSE(none.running_key.empty());
    CHECK_THROWS_WITH(drop_invalid_occupations(none, kListedSites, folder.path()),
                      !ContainsSubstring("ends before"));
    CHECK(until("2020-01-01T08:00:01Z").windows.size() == 1);
    log += R"({"type":"setup","utc":"2020-01-01T08:06:00Z"})"
           "\n";
    CHECK(until("2020-01-01T08:06:00Z").windows.size() == 1);
    CHECK(until("2020-01-01T08:06:01Z").windows.size() == 2);
}
