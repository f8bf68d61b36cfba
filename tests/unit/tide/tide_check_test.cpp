#include "corrector/tide/tide_check.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::tide;

namespace {

const UtcTime kMidnight = *parse_rfc3339("2017-04-17T00:00:00Z");
const Station kDenver{Degrees(39.5), Degrees(-105.0), Metres(1577.0)};

/// Returns the right tide of each five minutes of a day, with a wrong clock and place.
std::vector<UsedTide> day(std::chrono::minutes clock = {}, const Station& written = kDenver) {
    std::vector<UsedTide> tides;
    for (std::chrono::minutes at{0}; at <= std::chrono::hours(24); at += std::chrono::minutes(5))
        tides.push_back(
            {kMidnight + at + clock, written, usual_tide(kMidnight + at, kDenver).value()});
    return tides;
}

std::string remedy(const std::vector<UsedTide>& tides, const Agreement& agreement) {
    const auto doubt = find_doubt(tides, agreement, usual_tide);
    return doubt ? doubt->remedy.english() : "agrees";
}

}  // namespace

TEST_CASE("a tide that does not agree is named with what would make it agree") {
    for (const Agreement& agreement : {kTideOfInstrument, kTideOfAnyTable}) {
        CHECK(remedy(day(), agreement) == "agrees");
        CHECK(remedy(day(std::chrono::hours(9)), agreement) ==
              "; it fits if -9.0 h are added to the times");
        CHECK(remedy(day(std::chrono::minutes(-330)), agreement) ==
              "; it fits if +5.5 h are added to the times");
        Station other = kDenver;
        other.longitude = Degrees(105.0);
        CHECK(remedy(day({}, other), agreement) ==
              "; it fits with the other sign of the longitude");
        other = kDenver;
        other.latitude = Degrees(-39.5);
        CHECK(remedy(day({}, other), agreement) == "; it fits with the other sign of the latitude");
        auto tides = day();
        for (UsedTide& used : tides) used.tide_mgal *= -1.0;
        CHECK(remedy(tides, agreement) == "; it fits with the other sign of the tide");
        for (UsedTide& used : tides) used.tide_mgal *= 2.0;
        CHECK(remedy(tides, agreement).empty());
        for (UsedTide& used : tides) used.tide_mgal = 0.0;
        CHECK(find_doubt(tides, agreement, usual_tide)->is_zero);
    }
    CHECK_FALSE(find_doubt({}, kTideOfInstrument, usual_tide));
}

TEST_CASE("a constant is a doubt only where it is known") {
    auto tides = day();
    for (UsedTide& used : tides) used.tide_mgal += 0.04;
    CHECK(remedy(tides, kTideOfAnyTable) == "agrees");
    CHECK(find_doubt(tides, kTideOfInstrument, usual_tide)->size_mgal == Approx(0.04));
}

TEST_CASE("one wrong tide among many is the worst, and no shift of the times") {
    auto tides = day();
    tides[8].tide_mgal += 0.05;
    for (const Agreement& agreement : {kTideOfInstrument, kTideOfAnyTable}) {
        const auto doubt = find_doubt(tides, agreement, usual_tide);
        REQUIRE(doubt);
        CHECK(doubt->index == 8);
        CHECK(doubt->size_mgal == Approx(0.05).margin(0.001));
        CHECK(doubt->remedy.empty());
        // The search tries only a part of so many tides.  Its result must fit all of them.
        auto late = day(std::chrono::hours(9));
        late[8].tide_mgal += 0.05;
        CHECK(remedy(late, agreement).empty());
    }
}

TEST_CASE("a day of twenty readings shows the same, with another factor and rounded tides") {
    // 1.20 was usual in Japan.
    const Station tsukuba{Degrees(36.1), Degrees(140.1), Metres(20.0)};
    const auto readings = [&tsukuba](std::chrono::minutes clock, const Station& written,
                                     int first_day) {
        std::vector<UsedTide> tides;
        for (int i = 0; i < 20; ++i) {
            const UtcTime at =
                kMidnight + std::chrono::hours(43 * first_day) + i * std::chrono::minutes(30);
            const double tide_mgal = direct_tide(at, tsukuba, {1.20, 1.07}).value();
            tides.push_back({at + clock, written, std::round(tide_mgal * 1000.0) / 1000.0});
        }
        return tides;
    };
    Station east{tsukuba}, south{tsukuba};
    east.longitude = Degrees(-140.1);
    south.latitude = Degrees(-36.1);
    int hours = 0, longitudes = 0, latitudes = 0;
    for (int day = 0; day < 30; ++day) {
        INFO("day " << day);
        const auto agrees_or = [](const std::string& found, const std::string& expected,
                                  int& count) {
            if (found == expected) ++count;
            return found == expected || found.empty() || found == "agrees";
        };
        CHECK(agrees_or(remedy(readings(std::chrono::hours(9), tsukuba, day), kTideOfAnyTable),
                        "; it fits if -9.0 h are added to the times", hours));
        CHECK(agrees_or(remedy(readings({}, east, day), kTideOfAnyTable),
                        "; it fits with the other sign of the longitude", longitudes));
        CHECK(agrees_or(remedy(readings({}, south, day), kTideOfAnyTable),
                        "; it fits with the other sign of the latitude", latitudes));
        auto tides = readings({}, tsukuba, day);
        tides[static_cast<std::size_t>(day % 20)].tide_mgal += 0.05;
        CHECK(find_doubt(tides, kTideOfAnyTable, usual_tide)->remedy.empty());
    }
    CHECK(hours >= 15);
    CHECK(longitudes >= 15);
    CHECK(latitudes >= 15);
}

TEST_CASE("hours are not named where the tide fits several of them") {
    const auto tides = day(std::chrono::hours(9));
    // Two hours, in which the tide varies by less than 0.05 mGal.
    CHECK(remedy({tides.begin(), tides.begin() + 24}, kTideOfInstrument).empty());
    // A tide of one wave of half a day fits twice a day.
    const auto wave = [](UtcTime time, const Station&) {
        return MilliGal(0.1 *
                        std::sin(6.283185307179586 * seconds_between(kMidnight, time) / 43200.0));
    };
    auto waves = tides;
    for (UsedTide& used : waves)
        used.tide_mgal = wave(used.time + std::chrono::hours(3), kDenver).value();
    const auto doubt = find_doubt(waves, kTideOfInstrument, wave);
    REQUIRE(doubt);
    CHECK(doubt->remedy.empty());
}
