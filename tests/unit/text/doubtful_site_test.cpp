#include "protocol/text/doubtful_site.hpp"

#include "protocol/core/normal_gravity.hpp"
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::text;

namespace {

/// Returns four sites within 5 km of each other, with references equal to normal gravity.
std::vector<Site> good_list() {
    std::vector<Site> list;
    for (const double step : {0.0, 0.01, 0.02, 0.03}) {
        const Degrees latitude(36.2 + step);
        const Metres altitude(100.0 + 10000.0 * step);
        list.push_back({"S" + std::to_string(list.size()), Degrees(140.1), latitude, altitude,
                        normal_gravity(latitude, altitude)});
    }
    return list;
}

}  // namespace

TEST_CASE(
    "a good list of sites has no doubtful one, also with a longitude of 220 degrees for -140") {
    auto list = good_list();
    for (Site& site : list) site.longitude = Degrees(-140.0);
    list[1].longitude = Degrees(220.0);
    CHECK(doubtful_site(list).empty());
    CHECK(doubtful_site({}).empty());
    CHECK(doubtful_site({list.front()}).empty());
    CHECK(doubtful_site(read_sites(A351_GOLDEN "/tsukuba/sites.csv")).empty());
}

TEST_CASE("a site far from every other one is named") {
    auto list = good_list();
    list[2].longitude = Degrees(-140.1);  // the sign
    list[1].latitude = Degrees(35.1);     // less far
    CHECK(doubtful_site(list) ==
          "S2 is 6930 km from S3, the nearest other site: check longitude and latitude of both");
    list[2].is_placed = false;
    CHECK_THAT(doubtful_site(list).english(), StartsWith("S1 is 122 km from"));
}

TEST_CASE("an altitude that differs from that of the neighbours is named") {
    auto list = good_list();
    for (Site& site : list) site.gravity.reset();
    list[3].altitude = Metres(2000.0);
    CHECK(doubtful_site(list) ==
          "the altitude of S3 differs by +1800 m from its neighbours: check it");
    list[3].altitude = Metres(1699.0);
    CHECK(doubtful_site(list).empty());
    list[3].altitude = Metres(2000.0);
    CHECK(doubtful_site({list[3], list[0]}).empty());  // One neighbour decides nothing.
    list[3].has_altitude = false;
    CHECK(doubtful_site(list).empty());
}

TEST_CASE("a recorder far from all sites is named, after a site that is") {
    auto list = good_list();
    Site station{"[station]", Degrees(140.2), Degrees(36.2), Metres(4000.0), std::nullopt};
    CHECK(doubtful_site(list, &station).empty());
    station.longitude = Degrees(8.5);
    CHECK(doubtful_site({}, &station).empty());
    CHECK_THAT(doubtful_site(list, &station).english(), StartsWith("[station] is "));
    list[2].longitude = Degrees(8.5);
    CHECK_THAT(doubtful_site(list, &station).english(), StartsWith("S2 is "));
}

TEST_CASE("a reference that is not that of its place is named") {
    auto list = good_list();
    list[1].gravity = *list[1].gravity - MilliGal(299.0);
    CHECK(doubtful_site(list).empty());
    list[1].gravity = *list[1].gravity - MilliGal(2.0);
    CHECK(doubtful_site(list) ==
          "the reference of S1 differs by -301 mGal from normal gravity at its latitude and "
          "altitude: check all three");
    list[1].has_altitude = false;
    CHECK(doubtful_site(list).empty());
}

TEST_CASE("a name in another writing is like it, and another number is not") {
    using Pair = std::pair<const char*, const char*>;
    for (const auto& [one, other] :
         {Pair("No.1", "no.1"), Pair("No.1", "NO. 01"), Pair("16", "0016"),
          Pair("16", "16.0000000"), Pair("P7", "P007"), Pair("0", "000"), Pair("測点1", "測点 01")})
        CHECK(differ_in_writing(one, other));
    for (const auto& [one, other] :
         {Pair("16", "16"), Pair("1.1", "1.10"), Pair("1.1", "1.01"), Pair("16", "160"),
          Pair("0", "1"), Pair("S-1", "S1"), Pair("10", "100"), Pair("測点1", "測点2")})
        CHECK_FALSE(differ_in_writing(one, other));
}

TEST_CASE("two names that differ only in capitals, blanks or zeros are one doubt") {
    auto list = good_list();
    list[3].name = "s 1";
    CHECK(doubtful_site(list) ==
          "the names S1 and s 1 differ only in capitals, blanks or zeros: use one of them");
    list[3].name = "S-1";
    CHECK(doubtful_site(list).empty());
}
