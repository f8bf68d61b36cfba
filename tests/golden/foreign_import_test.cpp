// Files as other people bring them: tests/golden/foreign/README.md.
#include "tests/support/catch.hpp"

#include "corrector/gravimeter/contradictions.hpp"
#include "corrector/gravimeter/stays.hpp"
#include "corrector/tide/earth_tide.hpp"
#include "protocol/core/input_error.hpp"

using namespace a351;
using namespace a351::corrector::gravimeter;

namespace {

GravimeterFile read(const std::string& file) {
    return read_gravimeter_file(A351_GOLDEN "/foreign/" + file);
}

/// Returns the stays of a file as "site occupation readings; ".
std::string stays_of(const std::string& file) {
    std::vector<GravimeterFile> files{
        read_gravimeter_file(A351_GOLDEN "/foreign/" + file, {std::chrono::hours(8)})};
    std::string text;
    for (const Stay& stay : find_stays(files))
        text += stay.site + " " + std::to_string(stay.occupation) + " " +
                std::to_string(stay.readings.size()) + "; ";
    return text;
}

std::vector<std::string> remarks(const GravimeterFile& file) {
    return text::in_english(contradictions(file, [](UtcTime time, const Position& at) {
        return corrector::tide::direct_tide(time, {at.latitude, at.longitude, at.altitude});
    }));
}

}  // namespace

TEST_CASE("a Burris file of the Android program is read by the names of its columns",
          "[golden][foreign]") {
    const GravimeterFile file = read("burris-android-20-columns/burris.csv");
    CHECK(file.format == "ZLS Burris");
    CHECK(file.layout == "20 columns, by name");
    CHECK(file.refused.empty());
    CHECK(file.readings.front().instrument == "B-77");
    CHECK(file.readings.front().dial == "2800");
    CHECK(file.readings.front().tide_correction == MilliGal(-0.011));
    CHECK(stays_of("burris-android-20-columns/burris.csv") == "K1 1 4; K2 1 4; K3 1 4; K1 2 4; ");
}

TEST_CASE("a damaged dial is refused and opens no loop", "[golden][foreign]") {
    std::vector<GravimeterFile> files{read("burris-damaged-dial/burris.txt")};
    const auto stays = find_stays(files);
    REQUIRE(files[0].refused.size() == 1);
    CHECK(files[0].refused[0].line == 4);
    CHECK_THAT(files[0].refused[0].reason, ContainsSubstring("Dial = abcd: not a number"));
    REQUIRE(stays.size() == 1);
    CHECK(stays[0].readings.size() == 7);
}

TEST_CASE("a CG-5 whose lines begin with LAT and LONG has its stations in the notes",
          "[golden][foreign]") {
    const GravimeterFile file = read("cg5-latlong-station-in-note/cg5.txt");
    CHECK_THAT(file.layout, ContainsSubstring("station from the first word of the line Note:"));
    CHECK(file.readings.front().position->latitude == Degrees(47.2456627));
    CHECK(stays_of("cg5-latlong-station-in-note/cg5.txt") == "A 1 3; B 1 3; A 2 3; C 1 3; A 3 3; ");
}

TEST_CASE("a file whose readings are all refused is refused with the first of them",
          "[golden][foreign]") {
    CHECK_THROWS_WITH(
        read("cg6-us-date/cg6.dat"),
        ContainsSubstring("cg6.dat:13: Date Time = 06/12/2024 20:00:30: not an instant") &&
            ContainsSubstring("9 lines are refused"));
}

TEST_CASE("a wrong GMT DIFF. is seen from the tide in the file, with the hours that are missing",
          "[golden][foreign]") {
    CHECK(remarks(read("cg5-wrong-gmt-diff/right.txt")).empty());
    const auto found = remarks(read("cg5-wrong-gmt-diff/wrong.txt"));
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0],
               ContainsSubstring("the tide in the file is that of another time or place") &&
                   ContainsSubstring("by up to 0.25") &&
                   ContainsSubstring("it fits if -18.0 h are added to the times") &&
                   ContainsSubstring("GMT DIFF., LONG and LAT"));
}

TEST_CASE("a tide that hardly varies names no hours", "[golden][foreign]") {
    const auto found = remarks(read("burris-android-20-columns/burris.csv"));
    REQUIRE(found.size() == 1);  // its tide column is made up
    CHECK_THAT(found[0],
               ContainsSubstring("another time or place") && !ContainsSubstring("it fits"));
}

TEST_CASE("the files of real instruments contradict themselves nowhere", "[golden][foreign]") {
    for (const std::string file : {"B44_2017-12-05.txt", "B44_2018-02-27.txt",
                                   "B108_2017-12-05.txt", "cg5_excerpt.txt", "CG-6_TestData.dat"}) {
        INFO(file);
        const auto found = remarks(read_gravimeter_file(A351_GOLDEN "/usgs/" + file));
        CHECK(found == std::vector<std::string>());
    }
}

TEST_CASE("both forms of Lynx LG give the same stays, with the tide that is computed",
          "[golden][foreign]") {
    for (const std::string file : {"cg6-lynx-notes/cg6.dat", "cg6-tsoft/cg6.dat"}) {
        INFO(file);
        CHECK(read(file).refused.empty());
        CHECK(stays_of(file) == "P1 1 3; P2 1 3; P1 2 3; ");
    }
    CHECK(remarks(read("cg6-lynx-notes/cg6.dat")).empty());
    const auto found = remarks(read("cg6-tsoft/cg6.dat"));
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], ContainsSubstring("stay numbers come back after other stations (1); the "
                                           "longest pause is 1.0 h, at P1 with number 1"));
}

TEST_CASE("a GCYM table has its loops and its break of the day", "[golden][foreign]") {
    CHECK(stays_of("gcym/day.098") ==
          "90000001 1 1; 90000002 1 1; 90000002 2 1; 90000001 2 1; 90000001 3 1; ");
}
