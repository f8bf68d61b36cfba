#include "corrector/reduction/air_pressure.hpp"

#include <chrono>
#include <vector>

#include "protocol/archive/miniseed.hpp"
#include "protocol/archive/sds.hpp"
#include "protocol/files/file_layer.hpp"
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

TEST_CASE("the pressure is linear between the rows, and absent in gaps and outside") {
    const AirPressure record = pressure(
        "2026-03-01T00:00:00Z,900\n2026-03-01T10:00:00+09:00,904\n2026-03-01T05:00:00Z,910\n");
    CHECK(record.at(at("00:15:00")).value() == 901.0);
    CHECK(record.at(at("00:00:00")).value() == 900.0);
    CHECK(record.at(at("00:59:59")));
    CHECK_FALSE(record.at(at("01:00:01")));  // four hours without a row
    CHECK_FALSE(record.at(at("05:00:01")));
    CHECK_FALSE(record.at(at("00:00:00") - std::chrono::seconds(1)));
}

TEST_CASE("a pressure that is no pressure of the ground is refused with its line") {
    CHECK_THROWS_WITH(pressure("2026-03-01T00:00:00Z,900\n2026-03-01T01:00:00Z,90400\n"),
                      ContainsSubstring("pressure.csv:3: pressure_hpa = 90400"));
    CHECK_THROWS_WITH(pressure("2026-03-01T01:00:00Z,900\n2026-03-01T00:00:00Z,900\n"),
                      ContainsSubstring("not after the row before it"));
    CHECK_THROWS_WITH(pressure("2026-03-01T01:00:00Z,900\n"), ContainsSubstring("too few rows"));
}

TEST_CASE("a barometer's channel in the archive gives the pressure of a reading") {
    const test::TemporaryDirectory folder;
    const UtcTime start = *parse_rfc3339("2026-03-01T23:00:00Z");
    auto channel = pressure_channel("XX.BARO.00.LDO").value();
    channel.archive = folder.path() / "archive";
    archive::SdsWriter writer(files::posix_files(), channel.archive, channel.codes);
    archive::RecordHeader header;
    header.network = "XX";
    header.station = "BARO";
    header.location = "00";
    header.channel = "LDO";
    header.nominal_rate = Hertz(1.0);
    // Two hours over midnight, 900 hPa and 1 Pa more each minute, without the barometer in minute 30.
    for (int minute = 0; minute < 120; ++minute) {
        const std::vector<std::int32_t> counts(60, minute == 30 ? 0 : 90000 + minute);
        header.start = start + std::chrono::minutes(minute);
        writer.append("LDO", archive::pack_record(header, counts));
    }
    writer.sync();
    const UtcTime end = start + std::chrono::hours(2);
    CHECK(channel.files(start, end).size() == 2);
    std::vector<text::Message> warnings;
    const AirPressure record = AirPressure::read(channel, start, end, warnings);
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings.front(), ContainsSubstring("XX.BARO.00.LDO") &&
                                     ContainsSubstring("left out: 60, the first 0.00 hPa"));
    CHECK(record.at(start + std::chrono::seconds(30 * 60 + 30)).value() ==
          Approx(900.3).epsilon(0).margin(0.01));
    CHECK(record.at(start + std::chrono::seconds(90 * 60 + 30)).value() ==
          Approx(900.9).epsilon(0).margin(1e-9));
    CHECK_FALSE(record.at(end + std::chrono::hours(1)));

    channel.counts_per_hpa = 1.0;
    CHECK_THROWS_WITH(AirPressure::read(channel, start, end, warnings),
                      ContainsSubstring("XX.BARO.00.LDO: 90000.00 hPa") &&
                          ContainsSubstring("pressure_counts_per_hpa"));
    channel.codes.station = "OTHER";
    CHECK_THROWS_WITH(AirPressure::read(channel, start, end, warnings),
                      ContainsSubstring("no samples"));
    for (const char* const bad : {"XX.BARO.00.LNO", "XX.BARO.LDO", "XX.../.LDO", "XX.BARO.00.LdO"})
        CHECK_FALSE(pressure_channel(bad));
    CHECK(pressure_channel("XX.BARO..LDI"));
}
