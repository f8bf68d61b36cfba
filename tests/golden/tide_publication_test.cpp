// Tide of the survey day against the publication's column.  Data: tests/golden/tsukuba/README.md.
// The last cases show that the comparison would catch the mistakes people make.
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>
#include "tests/support/catch.hpp"

#include "corrector/tide/earth_tide.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/sites.hpp"

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::tide;

namespace {

constexpr tide::Factors kPublicationFactors{1.20, 1.20};

using TideOf = std::function<double(UtcTime, const tide::Station&)>;

/// Per row of tide_check.csv: the model minus the named column, mGal.
std::vector<double> deviations(const TideOf& tide_mgal, const std::string& column) {
    const auto table = text::read_csv(A351_GOLDEN "/tsukuba/tide_check.csv");
    const auto sites = text::read_sites(A351_GOLDEN "/tsukuba/sites.csv");
    std::vector<double> result;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        const auto* site = text::find_site(sites, table.cell(row, "site"));
        REQUIRE(site != nullptr);
        result.push_back(tide_mgal(parse_rfc3339(table.cell(row, "time_utc")).value(),
                                   {site->latitude, site->longitude, site->altitude}) -
                         table.number(row, column));
    }
    REQUIRE(result.size() == 19);
    return result;
}

double greatest(const std::vector<double>& values) {
    double greatest = 0.0;
    for (const double value : values) greatest = std::max(greatest, std::abs(value));
    return greatest;
}

double publication_tide(UtcTime time, const tide::Station& station) {
    return direct_tide(time, station, kPublicationFactors).value();
}

}  // namespace

TEST_CASE("the direct tide times 1.20 is within 0.0007 mGal of the publication's column") {
    CHECK(greatest(deviations(publication_tide, "table_mgal")) <= 0.0007);
}

TEST_CASE("the direct tide times 1.20 rounds to the publication's value in 18 of 19 rows") {
    // Half a unit of the printed digit plus 0.0001 mGal, the accuracy of the method: No.2 (1) is
    // 0.001506 here and 0.00149 in the harmonic catalogue, on either side of the rounding.
    const auto difference = deviations(publication_tide, "table_mgal");
    CHECK(std::count_if(difference.begin(), difference.end(),
                        [](double d) { return std::abs(d) < 0.0005 + 0.0001; }) == 18);
    CHECK(std::count_if(difference.begin(), difference.end(),
                        [](double d) { return std::abs(d) < 0.0005; }) == 17);
}

TEST_CASE("the column of observations.csv is the one of tide_check.csv") {
    const auto check = text::read_csv(A351_GOLDEN "/tsukuba/tide_check.csv");
    const auto observations = text::read_csv(A351_GOLDEN "/tsukuba/observations.csv");
    REQUIRE(check.row_count() == observations.row_count());
    for (std::size_t row = 0; row < check.row_count(); ++row) {
        CAPTURE(row);
        CHECK(check.number(row, "table_mgal") == observations.number(row, "earth_tide_mgal"));
        CHECK(parse_rfc3339(check.cell(row, "time_utc")) ==
              parse_rfc3339_in_zone(observations.cell(row, "time_jst"), std::chrono::hours(9)));
    }
}

TEST_CASE("the direct rigid tide repeats the check column to 0.0001 mGal") {
    const auto rigid = [](UtcTime time, const tide::Station& station) {
        return direct_tide(time, station, kRigidEarth).value();
    };
    CHECK(greatest(deviations(rigid, "rigid_mgal")) <= 0.0001);
}

TEST_CASE("Longman's tide repeats its two check columns to their rounding") {
    const auto rigid = [](UtcTime time, const tide::Station& station) {
        return longman_tide(time, station, kRigidEarth).value();
    };
    const auto usual = [](UtcTime time, const tide::Station& station) {
        return longman_tide(time, station).value();
    };
    CHECK(greatest(deviations(rigid, "longman_rigid_mgal")) <= 0.00001);
    CHECK(greatest(deviations(usual, "longman_x1.1575_mgal")) <= 0.00001);
}

TEST_CASE("a tide of the wrong sign misses the publication's column by 0.08 mGal") {
    const auto wrong = [](UtcTime time, const tide::Station& station) {
        return -publication_tide(time, station);
    };
    CHECK(greatest(deviations(wrong, "table_mgal")) == Approx(0.082).margin(0.001));
}

TEST_CASE("local time taken for UTC misses the publication's column by 0.10 mGal") {
    const auto wrong = [](UtcTime time, const tide::Station& station) {
        return publication_tide(time + std::chrono::hours(9), station);
    };
    CHECK(greatest(deviations(wrong, "table_mgal")) == Approx(0.104).margin(0.001));
}

TEST_CASE("longitude counted west misses the publication's column by 0.11 mGal") {
    const auto wrong = [](UtcTime time, const tide::Station& station) {
        return publication_tide(time, {station.latitude, -station.longitude, station.height});
    };
    CHECK(greatest(deviations(wrong, "table_mgal")) == Approx(0.109).margin(0.001));
}
