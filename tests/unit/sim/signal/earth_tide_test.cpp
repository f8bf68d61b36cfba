#include "sim/signal/earth_tide.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

#include "protocol/text/csv.hpp"

using namespace a351;

TEST_CASE("the tide agrees with a worked example of Longman's formulas", "[sim][tide]") {
    // Computed without this code: 40.7914 N, 282.1414 E, 370 m, 2015-04-23 00:00 UT, factor
    // 1.1575: 0.00354 mGal upward.
    const UtcTime time = *parse_rfc3339("2015-04-23T00:00:00Z");
    const MilliGal tide =
        sim::signal::earth_tide(Degrees(40.7914), Degrees(282.1414), Metres(370.0), time, 1.1575);
    CHECK(tide.value() == Approx(-0.00354).margin(5e-6));
}

TEST_CASE("the tide is proportional to the factor", "[sim][tide]") {
    const UtcTime time = *parse_rfc3339("2017-07-16T03:00:00Z");
    const auto tide = [&](double factor) {
        return sim::signal::earth_tide(Degrees(36.2), Degrees(140.1), Metres(500.0), time, factor)
            .value();
    };
    CHECK(tide(1.16) == Approx(1.16 * tide(1.0)).epsilon(1e-14));
}

TEST_CASE("the tide of the survey day agrees with the publication's column", "[sim][tide]") {
    // The column is 1.20 times the rigid Earth's tide (tests/golden/tsukuba/README.md), rounded to
    // 0.001 mGal; Longman's formulas are good to 0.003 mGal.
    const text::CsvTable sites = text::read_csv(A351_GOLDEN "/tsukuba/sites.csv");
    const text::CsvTable rows = text::read_csv(A351_GOLDEN "/tsukuba/observations.csv");
    for (std::size_t row = 0; row < rows.row_count(); ++row) {
        std::size_t site = 0;
        while (sites.cell(site, "site") != rows.cell(row, "site")) ++site;
        const UtcTime time = *parse_rfc3339(rows.cell(row, "time_jst") + "+09:00");
        const MilliGal tide =
            sim::signal::earth_tide(Degrees(sites.number(site, "latitude_deg")),
                                    Degrees(sites.number(site, "longitude_deg")),
                                    Metres(sites.number(site, "altitude_m")), time, 1.20);
        CHECK(tide.value() == Approx(rows.number(row, "earth_tide_mgal")).margin(0.0035));
    }
}
