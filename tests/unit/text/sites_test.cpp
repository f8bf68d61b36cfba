#include "protocol/text/sites.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"

using namespace a351;
using namespace a351::text;

namespace {

std::filesystem::path written(const std::string& text) {
    const auto file =
        std::filesystem::temp_directory_path() /
        ("a351-sites-test-" + std::to_string(std::hash<std::string>{}(text)) + ".csv");
    std::ofstream(file) << text;
    return file;
}

const std::string kHeader = "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n";

}  // namespace

TEST_CASE("the calibration line has 14 sites with a gravity range of 192.941 mGal",
          "[text][sites]") {
    const auto sites = read_sites(A351_GOLDEN "/tsukuba/sites.csv");
    REQUIRE(sites.size() == 14);
    const Site* base = find_site(sites, "No.0");
    REQUIRE(base != nullptr);
    CHECK(base->gravity == MilliGal(979860.210));
    CHECK(base->altitude == Metres(532.442));
    CHECK(find_site(sites, "No.99") == nullptr);
    CHECK(&required_site(sites, "No.0") == base);
    CHECK_THROWS_WITH(required_site(sites, "No.99"),
                      "site No.99: unknown; allowed: a name of the table of sites");
}

TEST_CASE("an unknown station has no reference value", "[text][sites]") {
    const auto sites = read_sites(written(kHeader + "X,140,36,0,\n"));
    REQUIRE(sites.size() == 1);
    CHECK_FALSE(sites[0].gravity.has_value());
}

TEST_CASE("a reference has an uncertainty if the column is there", "[text][sites]") {
    const std::string header =
        "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal,u_gravity_mgal\n";
    const auto sites = read_sites(written(header + "X,140,36,0,979800,0.03\nY,140,36,0,979801,\n"));
    CHECK(sites.at(0).u_gravity.value() == MilliGal(0.03));
    CHECK_FALSE(sites.at(1).u_gravity.has_value());
    CHECK_THROWS_WITH(read_sites(written(header + "X,140,36,0,979800,-1\n")),
                      ContainsSubstring(":2: u_gravity_mgal = -1: out of range"));
}

TEST_CASE("a site without coordinates gets the mean position of the others, in any order",
          "[text][sites]") {
    const std::vector<std::string> rows{"W,179.9,-17.1,10,\n", "E,-179.7,-17.3,40,\n", "X,,,,\n",
                                        "H,179.8,-17.2,,\n"};
    const auto sites = read_sites(written(kHeader + rows[0] + rows[1] + rows[2] + rows[3]));
    CHECK(sites[2].longitude.value() == Approx(-180.0));
    CHECK(sites[2].latitude.value() == Approx(-17.2));
    CHECK(sites[2].altitude == Metres(25.0));
    CHECK(sites[3].altitude == Metres(25.0));
    CHECK(sites[3].latitude == Degrees(-17.2));
    const std::vector<bool> is_placed{true, true, false, true},
        has_altitude{true, true, false, false};
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(sites[i].is_placed == is_placed[i]);
        CHECK(sites[i].has_altitude == has_altitude[i]);
    }
    const auto turned = read_sites(written(kHeader + rows[3] + rows[2] + rows[1] + rows[0]));
    CHECK(turned[1].longitude == sites[2].longitude);
    CHECK(turned[1].latitude == sites[2].latitude);
}

TEST_CASE("a bad sites file is refused with its line", "[text][sites]") {
    CHECK_THROWS_WITH(read_sites(written("site,longitude_deg\nX,1\n")),
                      ContainsSubstring(":1: column latitude_deg is missing"));
    CHECK_THROWS_WITH(read_sites(written(kHeader + "X,nan,36,0,\n")),
                      ContainsSubstring(":2: longitude_deg = nan: not a number"));
    CHECK_THROWS_WITH(read_sites(written(kHeader + "X,1,36,0,\nX,1,36,0,\n")),
                      ContainsSubstring(":3: site = X: appears twice"));
    CHECK_THROWS_WITH(read_sites(written(kHeader + ",1,36,0,\n")),
                      ContainsSubstring(":2: site = : empty"));
    CHECK_THROWS_WITH(read_sites(written(kHeader + "X,1,36,,\nY,1,36,,\n")),
                      ContainsSubstring("altitude_m = : empty for every site"));
    // m/s2 instead of mGal.
    CHECK_THROWS_WITH(read_sites(written(kHeader + "X,1,36,0,9.799\n")),
                      ContainsSubstring(":2: gravity_mgal = 9.799: out of range"));
    CHECK_THROWS_WITH(read_sites(written(kHeader + "X,1,36,0,9.7986E+05\n")),
                      ContainsSubstring(":2: gravity_mgal = 9.7986E+05: rounded"));
}

TEST_CASE("a site whose name is not UTF-8 is refused with the remedy", "[text][sites]") {
    // "yama" in Shift_JIS, cut and overlong UTF-8, a surrogate
    for (const std::string name : {"\x8E\x52", "\xE5\xB1", "\xC0\xAF", "\xED\xA0\x80"})
        CHECK_THROWS_WITH(read_sites(written(kHeader + name + ",140,36,0,\n")),
                          ContainsSubstring(":2: site = ") && ContainsSubstring("CSV UTF-8"));
    CHECK(read_sites(written(kHeader + "\xE5\xB1\xB1,140,36,0,\n")).size() == 1);
}

TEST_CASE("names that a spreadsheet or another program would change are refused", "[text][sites]") {
    for (const std::string_view name :
         {"=1+1", "+A", "-A", "@A", "A\x01", "A\xC2\x85", "A\"B", "A\u200B"}) {
        CAPTURE(name);
        CHECK_THROWS_WITH(parse_sites(kHeader + std::string(name) + ",1,2,3,\n", "sites.csv"),
                          StartsWith("sites.csv:2: site = ") && ContainsSubstring("allowed: "));
        CHECK_FALSE(trouble_with_site_name(name).empty());
    }
    CHECK(parse_sites(kHeader + "No.0-1 (\xC3\xA9),1,2,3,\n", "s.csv").size() == 1);
}

TEST_CASE("altitudes reach from the deepest mine to the highest mountain", "[text][sites]") {
    for (const char* const good : {"-5000", "-3900.5", "8849"})
        CHECK(parse_sites(kHeader + std::string("A,1,2,") + good + ",\n", "s.csv").size() == 1);
    for (const char* const bad : {"-5001", "9001"})
        CHECK_THROWS_WITH(parse_sites(kHeader + std::string("A,1,2,") + bad + ",\n", "s.csv"),
                          ContainsSubstring("allowed: -5000 to 9000"));
}

TEST_CASE("a mistyped name is recognised if only one site is like it", "[text][sites]") {
    std::vector<Site> sites(5);
    sites[0].name = "No.6";
    sites[1].name = "No.60";
    sites[2].name = "BM-A";
    sites[3].name = "bm a";
    sites[4].name = "PÄ";
    for (const char* name : {"no.6", "NO 6", "no6", "No.6."})
        CHECK(similar_site(sites, name) == &sites[0]);
    for (const char* name : {"No.7", "", "...", "bma", "No", "PÖ"})
        CHECK(similar_site(sites, name) == nullptr);
}
