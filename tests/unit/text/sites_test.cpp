#include "protocol/text/sites.hpp"

#include <string>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"

using namespace a351;
using namespace a351::text;

namespace {

const std::string kHeader = "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n";

std::vector<Site> list_of(const std::string& text) { return parse_sites(text, "s.csv"); }

}  // namespace

TEST_CASE("the calibration line has 14 sites with a gravity range of 192.941 mGal") {
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

TEST_CASE("a site has the reference and the uncertainty that its row gives") {
    CHECK_FALSE(list_of(kHeader + "X,140,36,0,\n").at(0).gravity);
    const std::string header =
        "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal,u_gravity_mgal\n";
    const auto sites = list_of(header + "X,140,36,0,979800,0.03\nY,140,36,0,979801,\n");
    CHECK(sites.at(0).u_gravity.value() == MilliGal(0.03));
    CHECK_FALSE(sites.at(1).u_gravity);
    CHECK_THROWS_WITH(list_of(header + "X,140,36,0,979800,-1\n"),
                      StartsWith("s.csv:2: u_gravity_mgal = -1: out of range"));
}

TEST_CASE("a site without coordinates gets the mean position of the others, in any order") {
    const std::vector<std::string> rows{"W,179.9,-17.1,10,\n", "E,-179.7,-17.3,40,\n", "X,,,,\n",
                                        "H,179.8,-17.2,,\n"};
    const auto sites = list_of(kHeader + rows[0] + rows[1] + rows[2] + rows[3]);
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
    const auto turned = list_of(kHeader + rows[3] + rows[2] + rows[1] + rows[0]);
    CHECK(turned[1].longitude == sites[2].longitude);
    CHECK(turned[1].latitude == sites[2].latitude);
}

TEST_CASE("a bad list of sites is refused with its line") {
    CHECK_THROWS_WITH(list_of("site,longitude_deg\nX,1\n"),
                      StartsWith("s.csv:1: column latitude_deg is missing"));
    for (const auto& [rows, trouble] : std::initializer_list<std::pair<std::string, std::string>>{
             {"X,nan,36,0,\n", ":2: longitude_deg = nan: not a number"},
             {"X,1,36,0,\nX,1,36,0,\n", ":3: site = X: appears twice"},
             {",1,36,0,\n", ":2: site = : empty"},
             {"X,1,36,,\nY,1,36,,\n", "altitude_m = : empty for every site"},
             {"X,1,36,0,9.799\n", ":2: gravity_mgal = 9.799: out of range"},  // m/s2
             {"X,1,36,0,9.7986E+05\n", ":2: gravity_mgal = 9.7986E+05: rounded"}})
        CHECK_THROWS_WITH(list_of(kHeader + rows), ContainsSubstring(trouble));
    // From the deepest mine to the highest mountain.
    for (const std::string good : {"-5000", "-3900.5", "8849"})
        CHECK(list_of(kHeader + "A,1,2," + good + ",\n").size() == 1);
    for (const std::string bad : {"-5001", "9001"})
        CHECK_THROWS_WITH(list_of(kHeader + "A,1,2," + bad + ",\n"),
                          ContainsSubstring("allowed: -5000 to 9000"));
}

TEST_CASE("names that are not UTF-8, or that another program would change, are refused") {
    // "yama" in Shift_JIS, cut and overlong UTF-8, a surrogate
    for (const std::string name : {"\x8E\x52", "\xE5\xB1", "\xC0\xAF", "\xED\xA0\x80"})
        CHECK_THROWS_WITH(list_of(kHeader + name + ",140,36,0,\n"),
                          StartsWith("s.csv:2: site = ") && ContainsSubstring("CSV UTF-8"));
    for (const std::string name :
         {"=1+1", "+A", "-A", "@A", "A\x01", "A\xC2\x85", "A\"B", "A\u200B"}) {
        CAPTURE(name);
        CHECK_THROWS_WITH(list_of(kHeader + name + ",1,2,3,\n"),
                          StartsWith("s.csv:2: site = ") && ContainsSubstring("allowed: "));
        CHECK_FALSE(trouble_with_site_name(name).empty());
    }
    for (const std::string name : {"\xE5\xB1\xB1", "No.0-1 (\xC3\xA9)"})
        CHECK(list_of(kHeader + name + ",140,36,0,\n").size() == 1);
}

TEST_CASE("a mistyped name is recognised if only one site is like it") {
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
