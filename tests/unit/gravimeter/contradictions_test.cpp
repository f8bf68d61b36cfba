#include "corrector/gravimeter/contradictions.hpp"

#include <fmt/core.h>

#include "tests/unit/gravimeter/made_up_lines.hpp"

using namespace a351;
using namespace a351::corrector::gravimeter;
using namespace made_up;

namespace {

/// Returns the remarks on a file, with the tide of the made-up lines.
std::vector<std::string> remarks(const std::string& content, double tide_mgal) {
    return text::in_english(contradictions(
        read(content), [&](UtcTime, const corrector::tide::Station&) { return MilliGal(tide_mgal); }));
}

}  // namespace

TEST_CASE("positions of one station that differ are one remark with the worst") {
    const std::string one = cg6_reading("A", "10:00:00"), two = cg6_reading("A", "10:01:00");
    CHECK(remarks(cg6_header() + one + changed(two, "39.5", "39.5008"), 0.0488).empty());  // 89 m
    CHECK(remarks(cg6_header() + one + changed(two, "1577.0", "1586.0"), 0.0488).empty());
    CHECK(
        remarks(cg6_header() + one + changed(cg6_reading("B", "10:01:00"), "39.5", "38.5"), 0.0488)
            .empty());
    const auto found = remarks(cg6_header() + one + changed(two, "39.5", "39.5010") +
                                   changed(cg6_reading("A", "10:02:00"), "1577.0", "1547.0") +
                                   cg6_reading("B", "10:03:00") +
                                   changed(cg6_reading("B", "10:04:00"), "1577.0", "1590.0"),
                               0.0488);
    REQUIRE(found.size() == 1);
    CHECK(found[0] ==
          "positions of one station differ (stations: 2), the most at A: 0 m, and -30 m of height "
          "(lines 5 and 7), +9.25 mGal of normal gravity. The first position of a station is used");
}

TEST_CASE("a receiver that is far from the position entered is a remark") {
    const std::string line =
        changed(cg6_reading("A", "10:00:00"), "--\t--\t--", "39.5\t-105.0\t1577.0");
    CHECK(remarks(cg6_header() + line, 0.0488).empty());
    const auto found = remarks(cg6_header() + changed(line, "39.5", "39.4"), 0.0488);
    REQUIRE(found.size() == 1);
    CHECK(found[0] ==
          "the receiver is up to 11119 m from the position that was entered, at A (line 5), +8.87 "
          "mGal of normal gravity. The position that was entered is used");
}

TEST_CASE("a tide correction that is off for a part of the readings is a remark") {
    const auto found =
        remarks(cg6_header() + cg6_reading("A", "10:00:00") +
                    cg6_reading("A", "10:01:00", "11001") + cg6_reading("A", "10:02:00", "11001"),
                0.0488);
    REQUIRE(found.size() == 1);
    CHECK(
        found[0] ==
        "the tide correction is off in 2 of 3 readings, the first at line 6, where the tide is up "
        "to 0.049 mGal. Each reading is used as its header or flag says");
    CHECK(remarks(cg6_header() + cg6_reading("A", "10:00:00", "11001"), 0.1).empty());
}

TEST_CASE("a tide beyond the limit is a remark without hours, if many would fit") {
    const std::string content = cg6_header() + cg6_reading("A", "10:00:00");
    CHECK(remarks(content, 0.0488 + 0.0099).empty());
    const auto found = remarks(content, 0.0488 + 0.0101);
    REQUIRE(found.size() == 1);
    CHECK(found[0] ==
          "the tide in the file is that of another time or place, by up to 0.010 mGal (line 5): "
          "check the clock and the position. Times and positions are used as they are");
}

TEST_CASE("a tide correction that is 0 throughout is a remark of its own") {
    const std::string line = changed(burris_reading("a", "10:00:00"), "-0.103", "0");
    const auto found = remarks(line, 0.108);
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], ContainsSubstring("the tide correction is 0 in all readings"));
    CHECK(remarks(line, 0.009).empty());
}

TEST_CASE("a stay number that comes back after other stations is a remark") {
    const std::string header =
        "/ CG-6 Gravity Survey\n/ Meter: 007\n/ Tidal Correction: Disabled\n/ Column Headers:\n"
        "/ Year\n/ Month\n/ DayOfMonth\n/ Hour\n/ Minute\n/ Second\n/ CorrGravity(mGals)\n"
        "/ TidalCorr(mGals)\n/ \n";
    const auto block = [](const std::string& site, const std::string& number,
                          const std::string& hour, const std::string& value) {
        return "/ Station: " + site + "\n/ Occupation: " + number + "\n2017 7 24 " + hour +
               " 0 0 " + value + " 0.0\n2017 7 24 " + hour + " 1 0 " + value + " 0.0\n";
    };
    const std::string start =
        header + block("A", "1", "8", "1500.0") + block("B", "1", "9", "1510.0");
    CHECK(remarks(start + block("A", "2", "10", "1500.1"), 0.0).empty());
    CHECK(remarks(header + block("A", "1", "8", "1500.0") + block("A", "1", "9", "1500.0"), 0.0)
              .empty());
    const auto found =
        remarks(start + block("A", "1", "10", "1500.1") + block("B", "1", "12", "1510.5"), 0.0);
    REQUIRE(found.size() == 1);
    CHECK(found[0] ==
          "stay numbers come back after other stations (2); the longest pause is 3.0 h, at B "
          "with number 1 (lines 21 and 28), where the reading changes by +0.500 mGal. A new stay "
          "begins each time");
}
