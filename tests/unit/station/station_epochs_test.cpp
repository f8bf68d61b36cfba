// Epochs that extend_station_xml() adds when the sensor or its settings change.

#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "tests/unit/station/station_files.hpp"

namespace a351::station {
namespace {

using namespace std::chrono_literals;

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

std::string extended(const std::string& existing, Description station) {
    const File file(existing);
    const auto text = extend_station_xml(file.path(), station);
    REQUIRE(text);
    // The extended metadata already contain the description.
    CHECK_FALSE(extend_station_xml(File(*text).path(), station));
    station.start += 24h;
    CHECK_FALSE(extend_station_xml(File(*text).path(), station));
    return *text;
}

}  // namespace

TEST_CASE("a change begins a new epoch of the channels it affects") {
    auto station = description();
    const std::string first = to_station_xml(station);
    station.start += 24h;
    std::size_t concerned = 4;  // the sampled channels
    SECTION("serial number") {
        station.serial_number = "X0000002";
        concerned = 5;  // and the temperature derived from them
    }
    SECTION("product") {
        station.product_id = "A351AU10";
        concerned = 5;
    }
    SECTION("firmware") { station.firmware = 259; }
    SECTION("start-up test") { station.start_up_test = wire::StartUpTest::flash_error; }
    SECTION("filter") { station.filter = "k512_fc16"; }
    SECTION("declared rate") { station.declared_rate_hz = 50.0006; }
    SECTION("output rate") { station.output_rate_hz = 100; }
    SECTION("orientation") {
        station.codes.axes = {"1", "2", "3"};
        concerned = 3;  // all axes, because only their order identifies them
    }
    const auto second = extended(first, station);
    CHECK(count_of(second, "<Channel ") == 7 + concerned);
    CHECK(count_of(second, "endDate=\"2026-03-02T12:00:00.000000Z\"") == concerned);
    CHECK(count_of(second, "startDate=\"2026-03-02T12:00:00.000000Z\"") == concerned);
    CHECK(count_of(second, "<Station ") == 1);

    const File file(second);
    CHECK(file.read().codes == station.codes);
    CHECK(file.read().channels.size() == 7);
    CHECK(file.read(description().start + 1h).codes == description().codes);
    CHECK(file.read(description().start + 1h).channels.at(0).code == "BN1");
    CHECK(file.read(station.start).codes == station.codes);

    auto third = description();
    third.start += 48h;
    const auto text = extended(second, third);
    CHECK(count_of(text, "<Channel ") == 7 + 2 * concerned);
    CHECK(File(text).read().codes == third.codes);
}

TEST_CASE(
    "the epochs are read in order of time, each with its scales and its position, or not "
    "extended") {
    auto station = description();
    const auto first = to_station_xml(station);
    station.start += 24h;
    station.serial_number = "X0000002";
    const auto epochs = read_station_epochs(File(extended(first, station)).path());
    REQUIRE(epochs.size() == 2);
    CHECK(epochs.begin()->first == description().start);
    CHECK(epochs.begin()->second.serial_number == "X0000001");
    CHECK(epochs.rbegin()->first == station.start);
    CHECK(epochs.rbegin()->second.serial_number == "X0000002");
    CHECK(epochs.rbegin()->second.channels.size() == 7);
    CHECK(epochs.rbegin()->second.position.value().longitude == description().longitude);
    std::string without = first;
    without.erase(without.find("<Latitude>"), std::string("<Latitude>36.106</Latitude>").size());
    CHECK_FALSE(File(without).read().position);
    const std::string with = extended(without, station);
    CHECK(File(with).read().position.value().latitude == station.latitude);
    CHECK(with.find("<Latitude>") < with.find("<Longitude>"));
    const auto longitude = without.find("<Longitude>");
    without.erase(longitude, without.find("<Site>") - longitude);
    CHECK(File(extended(without, station)).read().position.value().elevation == station.elevation);
    // A time before all epochs gets those that are still open.
    CHECK(File(first).read(description().start - 1h).channels.size() == 7);
    for (const auto& text : {std::string(), first.substr(0, first.size() / 2), std::string("<a/>")})
        CHECK_THROWS_AS(extend_station_xml(File(text).path(), description()), InputError);
}

TEST_CASE("an oven that is added and removed has its own epochs") {
    auto station = description();
    const auto without = to_station_xml(station);
    station.start += 1h;
    station.has_oven = true;
    const auto with = extended(without, station);
    CHECK(count_of(with, "<Channel ") == 10);
    CHECK(count_of(with, "endDate") == 0);
    station.start += 1h;
    station.has_oven = false;
    const auto again = extended(with, station);
    CHECK(count_of(again, "<Channel ") == 10);
    CHECK(count_of(again, "endDate") == 3);
    CHECK(File(again).read().channels.size() == 7);
}

TEST_CASE("other station codes end the epochs of the former station") {
    auto station = description();
    const auto first = to_station_xml(station);
    station.start += 1h;
    SECTION("station") { station.codes.station = "B"; }
    SECTION("network") { station.codes.network = "GR"; }
    const auto second = extended(first, station);
    CHECK(count_of(second, "<Station ") == 2);
    CHECK(count_of(second, "endDate") == 7);
    CHECK(File(second).read().codes == station.codes);
    CHECK(File(second).read(description().start).codes == description().codes);
    auto third = description();
    third.start += 2h;
    const auto back = extended(second, third);
    CHECK(count_of(back, "<Station ") == 2);
    CHECK(File(back).read().codes == third.codes);
}

TEST_CASE("after a clock that was ahead, no epoch starts after its end") {
    auto station = description();
    const auto first = to_station_xml(station);
    station.start -= 24h;
    SECTION("the same settings were in use before") {
        const auto text = extended(first, station);
        CHECK(count_of(text, "startDate=\"2026-02-28T12:00:00.000000Z\"") == 8);
        CHECK(count_of(text, "2026-03-01") == 0);
    }
    SECTION("other settings were in use before") {
        station.firmware = 259;
        const auto text = extended(first, station);
        CHECK(count_of(text,
                       "startDate=\"2026-03-01T12:00:00.000000Z\" "
                       "endDate=\"2026-03-01T12:00:00.000000Z\"") == 4);
        CHECK(File(text).read(station.start).channels.size() == 7);
    }
}

}  // namespace a351::station
