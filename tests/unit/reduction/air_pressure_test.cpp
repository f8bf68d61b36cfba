#include "corrector/reduction/air_pressure.hpp"

#include "protocol/core/input_error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::corrector::reduction;

namespace {

AirPressure pressure(const std::string& rows) {
    const test::TemporaryDirectory folder;
    return AirPressure::read(folder.write("pressure.csv", "time,pressure_hpa\n" + rows));
}

UtcTime at(const std::string& time) { return parse_rfc3339("2026-03-01T" + time + "Z").value(); }

}  // namespace

TEST_CASE("the pressure is linear between the rows, and absent in gaps and outside",
          "[reduction]") {
    const AirPressure record = pressure(
        "2026-03-01T00:00:00Z,900\n2026-03-01T10:00:00+09:00,904\n2026-03-01T05:00:00Z,910\n");
    CHECK(record.at(at("00:15:00")).value() == 901.0);
    CHECK(record.at(at("00:00:00")).value() == 900.0);
    CHECK(record.at(at("00:59:59")));
    CHECK_FALSE(record.at(at("01:00:01")));  // four hours without a row
    CHECK_FALSE(record.at(at("05:00:01")));
    CHECK_FALSE(record.at(at("00:00:00") - std::chrono::seconds(1)));
}

TEST_CASE("a pressure that is no pressure of the ground is refused with its line", "[reduction]") {
    CHECK_THROWS_WITH(pressure("2026-03-01T00:00:00Z,900\n2026-03-01T01:00:00Z,90400\n"),
                      ContainsSubstring("pressure.csv:3: pressure_hpa = 90400"));
    CHECK_THROWS_WITH(pressure("2026-03-01T01:00:00Z,900\n2026-03-01T00:00:00Z,900\n"),
                      ContainsSubstring("not after the row before it"));
    CHECK_THROWS_WITH(pressure("2026-03-01T01:00:00Z,900\n"), ContainsSubstring("too few rows"));
}
