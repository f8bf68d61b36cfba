#include "corrector/archive_series/epoch.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::archive_series;

TEST_CASE("a channel that is missing or in another unit is refused") {
    station::Metadata station;
    station.channels = {{"BN1", 1.0, 0.0, "m/s**2"},
                        {"BN2", 1.0, 0.0, "m/s**2"},
                        {"BNZ", 1.0, 0.0, "m/s**2"},
                        {"LK1", 0.001, 0.0, "degC"},
                        {"BK1", 1.0, 0.0, "degC"}};
    const auto epoch = epoch_of({}, station, "station.xml");
    CHECK(epoch.channels[0].code == "BN1");
    CHECK(epoch.channels[kVertical].code == "BNZ");
    CHECK(epoch.channels[kTemperature].code == "BK1");
    CHECK_FALSE(epoch.has_outer());
    auto double_oven = station;
    double_oven.channels.push_back({"LK4", 0.001, 0.0, "degC"});
    CHECK(epoch_of({}, double_oven, "station.xml").channels.at(kOuter).gain == 0.001);
    station.channels.pop_back();
    CHECK_THROWS_WITH(epoch_of({}, station, "station.xml"),
                      ContainsSubstring("station.xml: no channel ?K1"));
    station.channels[1] = {"BN2", 1.0, 0.0, "g"};
    CHECK_THROWS_WITH(epoch_of({}, station, "station.xml"), ContainsSubstring("BN2: unit = g"));
}
