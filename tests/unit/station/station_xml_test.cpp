#include "protocol/station/station_xml.hpp"

#include <tuple>
#include <vector>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "protocol/station/station_document.hpp"
#include "tests/unit/station/station_files.hpp"

using namespace a351::journal;

namespace a351::station {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const auto at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("codes and scales of the sampled channels are read back from the metadata") {
    auto station = description();
    const auto text = to_station_xml(station);
    CHECK(text == to_station_xml(station));
    const auto metadata = File(text).read();
    CHECK(metadata.codes == StationCodes{});
    CHECK(metadata.noise_ug_per_sqrt_hz == 0.2);  // of the profile that a comment names
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(metadata.channels[i].offset == 0.0);
        // 2^24 counts are one g; the margin allows two roundings.
        CHECK(metadata.channels[i].gain * 16'777'216.0 == Approx(9.80665).epsilon(3e-16).margin(0));
    }
    // 1710799.916383270536 by long division; the nearest double in its shortest form.
    CHECK_THAT(text, ContainsSubstring("<Value>1710799.9163832706</Value>"));
    // M-A352AD10 data sheet 7.6.
    CHECK(metadata.channels[3].gain == -0.0037918);
    CHECK(metadata.channels[3].offset == 34.987);

    station.codes = {"GR", "AB", "", {"N", "Z", "E"}};
    const auto other = File(to_station_xml(station)).read();
    CHECK(other.codes == station.codes);
    CHECK(other.channels[1].code == "BNZ");
}

TEST_CASE("each oven adds its channels, with the rate of their samples") {
    using Channels = std::vector<std::tuple<std::string, std::string, double>>;  // code, unit, gain
    const double g = 1.0 / 1710799.9163832706;  // the sensitivity above
    const Channels sampled{{"BN1", "m/s**2", g},
                           {"BN2", "m/s**2", g},
                           {"BNZ", "m/s**2", g},
                           {"BK1", "degC", -0.0037918},
                           {"LK1", "degC", 0.001}};
    const Channels oven{{"LK2", "degC", 0.001}, {"LK3", "degC", 0.001}, {"LYH", "%", 0.01}};
    const Channels outer{{"LK4", "degC", 0.001}, {"LK5", "degC", 0.001}, {"LYO", "%", 0.01}};
    auto station = description();
    for (const int ovens : {0, 1, 2}) {
        station.has_oven = ovens > 0;
        station.has_outer_oven = ovens > 1;
        Channels expected = sampled;
        if (ovens > 0) expected.insert(expected.end(), oven.begin(), oven.end());
        if (ovens > 1) expected.insert(expected.end(), outer.begin(), outer.end());
        expected.insert(expected.end(), {{"LCE", "s", 1e-6}, {"LCQ", "%", 1.0}});
        Channels found;
        for (const auto& channel : File(to_station_xml(station)).read().channels)
            found.emplace_back(channel.code, channel.unit, channel.gain);
        CHECK(found == expected);
    }
    const auto slow_channels = [&] {
        const auto text = to_station_xml(station);
        std::size_t count = 0;
        for (auto at = text.find("<SampleRate>0.1<"); at != std::string::npos; ++count)
            at = text.find("<SampleRate>0.1<", at + 1);
        return count;
    };
    CHECK(slow_channels() == 0);
    station.outer_oven_interval = std::chrono::seconds(10);
    CHECK(slow_channels() == 3);
    station.oven_interval = std::chrono::seconds(10);
    CHECK(slow_channels() == 6);
    CHECK_THAT(to_station_xml(station), ContainsSubstring("<Frequency>0.01<"));  // below half
}

TEST_CASE("the clock drift is that of the declared rate") {
    CHECK_THAT(to_station_xml(description()), !ContainsSubstring("ClockDrift"));
    auto station = description();
    station.declared_rate_hz = 50.001;
    const auto text = to_station_xml(station);
    const auto at = text.find("<ClockDrift>");
    REQUIRE(at != std::string::npos);
    // 20 ppm of 20 ms; the schema requires a positive value.
    CHECK(std::stod(text.substr(at + 12)) == Approx(4e-7).epsilon(1e-4).margin(0));
}

TEST_CASE("StationXML has filter, firmware, serial number, rate, orientation, position and epoch") {
    const auto text = to_station_xml(description());
    for (const char* part :
         {"schemaVersion=\"1.2\"", "device profile A351 (unverified)",
          "group delay 0.063875 s, already subtracted from the time stamps", "filter k512_fc9",
          "firmware 258", "<SerialNumber>X0000001</SerialNumber>", "<Model>A352AD10</Model>",
          "<SampleRate>50</SampleRate>", "<Dip>-90</Dip>", "<Azimuth>90</Azimuth>",
          "orientation not surveyed", "<Longitude>140.087</Longitude>",
          "startDate=\"2026-03-01T12:00:00.000000Z\"", "axis y; x, y, z are 1, 2, Z"}) {
        CHECK_THAT(text, ContainsSubstring(part));
    }
    auto station = description();
    station.is_profile_verified = true;
    CHECK_THAT(to_station_xml(station), ContainsSubstring("device profile A351 (verified)") &&
                                            !ContainsSubstring("start-up test"));
    station.serial_number = "\x01\xFF<&\"";  // no text
    CHECK_THAT(to_station_xml(station),
               ContainsSubstring("<SerialNumber>??&lt;&amp;\"</SerialNumber>"));
    CHECK_NOTHROW(File(to_station_xml(station)).read());
    station.start_up_test = wire::StartUpTest::hard_error;
    CHECK_THAT(to_station_xml(station), ContainsSubstring("start-up test of the sensor: HARD_ERR"));
    station.profile = "A999";
    CHECK_THROWS_AS(to_station_xml(station), std::invalid_argument);
}

TEST_CASE("metadata as other programs write them are the same metadata") {
    // After obspy/core/tests/data/AU.MEEK.xml, IU_ANMO_00_BHZ.xml and GeoNet/delta #134.
    const auto all = [](std::string text, const std::string& from, const std::string& to) {
        for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
            text.replace(at, from.size(), to);
        return text;
    };
    const auto whole = to_station_xml(description());
    std::string prefixed = all(all(whole, "</", "</fsx:"), "<", "<fsx:");
    prefixed =
        all(all(all(prefixed, "<fsx:/fsx:", "</fsx:"), "<fsx:?", "<?"), "xmlns=", "xmlns:fsx=");
    const std::string text =
        GENERATE_COPY(std::string(whole), all(whole, "12:00:00.000000Z\"", "12:00:00\""),
                      all(whole, "startDate=\"2026-03-01T12:00:00",
                          "endDate=\"2599-12-31T23:59:59\" startDate=\"2026-03-01T12:00:00"),
                      all(whole, "m/s**2", "M/S**2"), all(whole, "m/s**2", "m/s^2"), prefixed);
    CAPTURE(text.substr(0, 600));
    const Metadata expected = File(whole).read();
    const File file(text);
    for (const auto& at : {std::optional<UtcTime>(), std::optional(description().start)}) {
        const Metadata read = file.read(at);
        REQUIRE(read.channels.size() == expected.channels.size());
        CHECK(read.channels[0].unit == "m/s**2");
        CHECK(read.channels[0].gain == expected.channels[0].gain);
        CHECK(read.codes.station == "A351");
        CHECK(read.position.has_value());
    }
    CHECK(xml_text(load_station_document(file.path())).find("<fsx:") == std::string::npos);
}

TEST_CASE("metadata that cannot be used are refused with the file's name") {
    const auto whole = to_station_xml(description());
    const std::string text = GENERATE_COPY(
        std::string(), std::string("no xml"), std::string("<a/>"), whole.substr(0, 2000),
        replaced(whole, "<Value>1710799", "<Value>x"), replaced(whole, "<Value>1", "<Value>-1"),
        replaced(whole, "code=\"BN1\"", "code=\"LK9\""),
        replaced(whole, "locationCode=\"00\" startDate=\"2026", "startDate=\"20260"),
        replaced(whole, "locationCode=\"00\" startDate=\"2026", "startDate=\"x"),
        replaced(whole, "<Name>m/s**2</Name>", "<Name/>"),
        replaced(whole, "<Coefficient number=\"1\">34.987</Coefficient>", ""));
    const File file(text);
    CHECK_THROWS_AS(file.read(), InputError);
    CHECK_THROWS_WITH(file.read(), ContainsSubstring("station.xml: "));
    CHECK_THROWS_AS(read_station_xml("/nonexistent/station.xml"), InputError);
}

}  // namespace a351::station
