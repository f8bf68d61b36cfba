#include "daemon/config/config.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include "daemon/config/verdict_config.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/wire/shipped_profiles.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351::daemon;
using namespace a351;
using namespace a351::daemon::config;
using namespace a351::daemon::source;
using namespace a351::daemon::verdict;

namespace {

const std::string kStation = "[station]\nlatitude = 36.1\nlongitude = 140.1\nelevation_m = 26\n";
const std::string kSensor = "[sensor]\nport = \"/dev/ttyUSB0\"\n";
const std::string kStorage = "[storage]\nroot = \"data\"\n";
const std::string kMinimal = kStation + kSensor + kStorage;

/// Returns the minimal configuration with a further line of [sensor].
std::string with_sensor(const std::string& line) {
    return kStation + kSensor + line + "\n" + kStorage;
}

struct Fixture {
    test::TemporaryDirectory directory;
    std::filesystem::path file = directory.path() / "a351d.toml";

    Config read(const std::string& text) const {
        std::ofstream(file) << text;
        return read_config(file);
    }

    /// Returns the error message without the directory, or "accepted".
    std::string refusal(const std::string& text) const {
        try {
            (void)read(text);
        } catch (const InputError& error) {
            std::string message = error.what();
            const std::string prefix = directory.path().string() + "/";
            for (auto at = message.find(prefix); at != std::string::npos; at = message.find(prefix))
                message.erase(at, prefix.size());
            return message;
        }
        return "accepted";
    }
};

}  // namespace

TEST_CASE_METHOD(Fixture, "a token that every user can read is noticed") {
    const std::string token = "[page]\ntoken = \"0123456789abcdef\"\n";
    for (const bool has_token : {false, true}) {
        const Config config = read(kMinimal + (has_token ? token : ""));
        std::filesystem::permissions(file, std::filesystem::perms(0644));
        CHECK(shows_token(config) == has_token);
        std::filesystem::permissions(file, std::filesystem::perms(0640));
        CHECK_FALSE(shows_token(config));
    }
}

TEST_CASE_METHOD(Fixture, "the profile is a name, or a file beside the configuration") {
    const auto with = [](const std::string& profile) {
        return kStation + kSensor + "profile = \"" + profile + "\"\n" + kStorage;
    };
    CHECK(read(with("A370AD10")).sensor.profile->rated_range == StandardGravity(10.0));

    std::string text(wire::shipped_profiles()[1].toml);
    const std::string slope = "slope_degc = -0.0037918",
                      slope_of_16_16 = "slope_degc = -5.78583e-8";
    text.replace(text.find(slope), slope.size(), slope_of_16_16);
    const auto path = directory.write("profiles/mine.toml", text);
    for (const std::string& given : {std::string("profiles/mine.toml"), path.string()}) {
        const Config config = read(with(given));
        CHECK(config.sensor.profile->temperature_slope_degc == -5.78583e-8);
        CHECK(config.station.profile == config.sensor.profile->name);
        CHECK(config.station.profile.starts_with("mine#"));
    }
    CHECK(refusal(with("A353")) ==
          "a351d.toml:7: sensor.profile = 'A353': neither a profile nor a file; allowed: " +
              text::joined(wire::profile_names()) + ", or a file");
    text.replace(text.find(slope_of_16_16), slope_of_16_16.size(), "slope_degc = 0.0");
    directory.write("profiles/mine.toml", text);
    CHECK(
        refusal(with("profiles/mine.toml")) ==
        "profiles/mine.toml:17: temperature.slope_degc = 0: has no inverse; allowed: a number from "
        "-1 to 1, but not 0");
}

TEST_CASE_METHOD(Fixture, "a minimal configuration has the documented defaults") {
    const Config config = read(kMinimal);
    CHECK(config.station.codes == journal::StationCodes{});
    CHECK(config.station.latitude == Degrees(36.1));
    CHECK(config.sensor.address.path == "/dev/ttyUSB0");
    CHECK(config.sensor.profile->name == "A351");
    CHECK(config.sensor.baud == 460800);
    CHECK(config.sensor.settings.output_rate_hz == 50);
    CHECK(config.sensor.settings.filter_code == 6);
    CHECK(config.storage.root == directory.path() / "data");
    CHECK(config.storage.journal_keep_days == 30);
    CHECK_FALSE(config.storage.declared_rate_hz);
    CHECK(to_string(config.page.listen) == "127.0.0.1:8351");
    CHECK_FALSE(config.oven);
    CHECK(config.survey.sites.empty());
    CHECK(config.survey.planned == std::chrono::minutes(10));
    CHECK(config.survey.set_ups == 1);
}

TEST_CASE("the annotated example is accepted") {
    const auto example = std::filesystem::path(A351_GOLDEN) / "../../config/a351d.toml";
    const Config config = read_config(example);
    CHECK(config.sensor.baud == 460800);
    CHECK(config.survey.sites.empty());
    CHECK(config.survey.planned == config.survey.set_ups * std::chrono::minutes(6));
    CHECK(config.survey.set_ups == 2);
    CHECK(config.verdict == verdict::Options{});
}

TEST_CASE_METHOD(Fixture, "every documented key is accepted and read") {
    std::ofstream(directory.path() / "sites.csv")
        << "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\nNo.0,140.1,36.1,26,\n";
    const Config config = read(
        "[station]\nnetwork=\"JP\"\nstation=\"TKB\"\nlocation=\"\"\nlatitude=36\nlongitude=140\n"
        "elevation_m=26.5\n[sensor]\nusb=\"0403:6001:A:5\"\nprofile=\"A352AD10\"\nbaud=230400\n"
        "output_rate_hz=100\nfilter=\"k512_fc16\"\nserial_number=\"00000042\"\naxes=\"Z,1,2\"\n"
        "[oven]\nenabled=true\nport=\"o\"\nbaud=19200\nparity=\"N\"\nunit=7\npoll_s=2.5\ndecimals="
        "2\n"
        "[oven.outer]\nenabled=true\nport=\"w\"\nunit=2\npoll_s=10\n"
        "[storage]\nroot=\"/var/lib/a351\"\ndeclared_rate_hz=100.0005\njournal_keep_days=0\n"
        "record_age_s=2\n"
        "[page]\nlisten=\"127.0.0.1:0\"\nhosts=[\"box\"]\ntoken=\"sixteen-or-longer\"\nassets=\"."
        "\"\nboxes=[\"http://192.0.2.7:8351\", \"https://box2\"]\n"
        "[survey]\nsites=\"sites.csv\"\ncalibration=\"\"\noccupation_min=15\nset_ups=3\n"
        "[verdict]\nwarm_up_degc=0.4\nknock_gal=3\n");
    CHECK(config.station.codes == journal::StationCodes{"JP", "TKB", "", {"Z", "1", "2"}});
    CHECK(config.sensor.address.usb == UsbAddress{0x0403, 0x6001, "A:5"});
    CHECK(config.sensor.settings.filter_code == 7);
    REQUIRE(config.oven);
    CHECK(config.oven->line.port == directory.path() / "o");
    CHECK(config.oven->line.baud == 19200);
    CHECK(config.oven->line.parity == 'N');
    CHECK(config.oven->line.unit == 7);
    CHECK(config.oven->poll_interval == std::chrono::milliseconds(2500));
    CHECK(config.oven->decimals == 2);
    CHECK(config.oven->place == journal::OvenPlace::inner);
    REQUIRE(config.outer_oven);
    CHECK(config.outer_oven->place == journal::OvenPlace::outer);
    CHECK(config.outer_oven->line.port == directory.path() / "w");
    CHECK(config.outer_oven->line.baud == 9600);
    CHECK(config.outer_oven->line.unit == 2);
    CHECK(config.station.has_outer_oven);
    const journal::Header header = journal_header(config, source::HostClock(std::nullopt));
    CHECK(header.oven_interval == std::chrono::seconds(3));
    CHECK(header.outer_oven_interval == std::chrono::seconds(10));
    CHECK(config.storage.declared_rate_hz == 100.0005);
    CHECK(config.storage.root == "/var/lib/a351");
    CHECK(config.storage.record_age == std::chrono::seconds(2));
    CHECK(std::filesystem::equivalent(config.page.assets, directory.path()));
    CHECK(config.page.boxes == std::vector<std::string>{"http://192.0.2.7:8351", "https://box2"});
    REQUIRE(config.survey.sites.size() == 1);
    CHECK(config.survey.planned == std::chrono::minutes(15));
    CHECK(config.survey.set_ups == 3);
    verdict::Options verdict;
    verdict.warm_up_degc = 0.4;
    verdict.knock_gal = 3.0;
    CHECK(config.verdict == verdict);
}

TEST_CASE("a pause of the host is no lack of data, however fast instrument time runs") {
    const source::HostClock real;
    CHECK(stale_after(real) == kStaleAfter);
    const source::HostClock fast(
        ClockScale{1000.0, source::host_realtime(), source::host_realtime()});
    CHECK(stale_after(fast) == std::chrono::seconds(500));
}

TEST_CASE_METHOD(Fixture,
                 "a configuration error names file, line, key, value and what is allowed") {
    CHECK(refusal(with_sensor("bits = 7")) ==
          "a351d.toml:7: sensor.bits = 7: unknown key; allowed: axes, baud, filter, "
          "output_rate_hz, port, profile, serial_number, usb");
    CHECK(refusal(with_sensor("baud = \"fast\"")) ==
          "a351d.toml:7: sensor.baud = 'fast': wrong type; allowed: a whole number from 0 to "
          "10000000");
    CHECK(refusal(with_sensor("baud = 9600")) ==
          "a351d.toml:7: sensor.baud = 9600: not a known value; allowed: 460800, 230400, 115200");
    CHECK(refusal("[station]\nstation = \"tkb\"\n") ==
          "a351d.toml:2: station.station = 'tkb': not a SEED code; allowed: 1 to 5 characters A-Z "
          "0-9");
    CHECK(refusal("[station]\nlocation = \"0\"\n") ==
          "a351d.toml:2: station.location = '0': not a SEED code; allowed: 2 characters A-Z 0-9, "
          "or empty");
    CHECK(refusal("[station]\nlatitude = 1\n") ==
          "a351d.toml:1: station.longitude: missing; allowed: degrees east, -180 to 360");
    CHECK(refusal(with_sensor("usb = \"0403:6001:X\"")) ==
          "a351d.toml:6: sensor.port = '/dev/ttyUSB0': given together with usb; allowed: exactly "
          "one of port and usb");
    CHECK(refusal(kStation + "[sensor]\nusb = \"X\"\n" + kStorage) ==
          "a351d.toml:6: sensor.usb = 'X': not an adapter's address; allowed: VID:PID:SERIAL as "
          "printed by a351d --list-ports");
    CHECK(refusal(kStation + "[sensor]\n" + kStorage) ==
          "a351d.toml:5: sensor.port: port and usb are both missing; allowed: exactly one of port "
          "and usb");
    CHECK(refusal(with_sensor("filter = \"k512_fc16\"")) ==
          "a351d.toml:7: sensor.filter = 'k512_fc16': not usable at 50 Hz with profile A351; "
          "allowed: k512_fc9");
    CHECK(refusal(with_sensor("axes = \"1,1,Z\"")) ==
          "a351d.toml:7: sensor.axes = '1,1,Z': not three channel suffixes; allowed: three "
          "different characters A-Z 0-9 for x, y, z, as \"1,2,Z\"");
    // 500 Hz x 24 bytes x 10 bits = 120 000 bit/s.
    CHECK(refusal(with_sensor("baud = 115200\noutput_rate_hz = 500\nfilter = \"k512_fc210\"")) ==
          "a351d.toml:7: sensor.baud = 115200: too slow for the output rate; allowed: at least "
          "120000 bit/s");
    std::filesystem::create_symlink("/dev/null", directory.path() / "sensor");
    std::filesystem::create_symlink("sensor", directory.path() / "oven");
    CHECK_THAT(refusal(kStation + "[sensor]\nport = \"sensor\"\n" + kStorage +
                       "[oven]\nenabled = true\nport = \"oven\"\n"),
               ContainsSubstring("oven.port = 'oven': the sensor's port"));
    const std::string before_oven = kMinimal + "[oven]\n";
    CHECK(refusal(before_oven + "enabled = true\n") ==
          "a351d.toml:9: oven.port: missing; allowed: the controller's serial port");
    CHECK(refusal(before_oven + "enabled = true\nport = \"/dev/../dev/ttyUSB0\"\n") ==
          "a351d.toml:11: oven.port = '/dev/../dev/ttyUSB0': the sensor's port; allowed: a port "
          "other than sensor.port");
    CHECK(refusal(before_oven + "baud = 14400\n") ==
          "a351d.toml:10: oven.baud = 14400: not a known value; allowed: 1200, 2400, 4800, 9600, "
          "19200, 38400, 57600, 115200");
    CHECK(refusal(before_oven + "parity = \"S\"\n") ==
          "a351d.toml:10: oven.parity = 'S': not a known value; allowed: E, O, N");
    CHECK(refusal(before_oven + "unit = 0\n") ==
          "a351d.toml:10: oven.unit = 0: out of range; allowed: a whole number from 1 to 99");
    CHECK_THAT(refusal(before_oven + "poll_s = 0\n"), ContainsSubstring("oven.poll_s = 0"));
    for (const std::string box :
         {"192.0.2.7:8351", "http://", "http://box/", "http://box; x",
          "http://box:", "http://box:0", "http://box:65536", "http://box:08351", "http://box:83x",
          "http://box:1:2", "http://:8351", "http://-", "http://box.", "http://[::1]:8351",
          "ftp://box"})
        CHECK_THAT(refusal(kMinimal + "[page]\nboxes = [\"" + box + "\"]\n"),
                   ContainsSubstring("not the address of a daemon: " + box + "; allowed: http://"));
    const std::string both = before_oven + "enabled = true\nport = \"o\"\n[oven.outer]\n";
    CHECK(refusal(both + "enabled = true\nport = \"o\"\n") ==
          "a351d.toml:14: oven.outer.port = 'o': the inner oven's port; allowed: a port other than "
          "oven.port");
    CHECK_THAT(refusal(both + "lid = 1\n"), ContainsSubstring("oven.outer.lid = 1: unknown key"));
    CHECK_THAT(refusal(kMinimal + "[page]\nassets = \"none\"\n"),
               ContainsSubstring("page.assets = 'none': no such directory: none; allowed: "));
    CHECK(refusal(kMinimal + "[survey]\nsites = \"no.csv\"\n") ==
          "a351d.toml:10: survey.sites = 'no.csv': no such file: no.csv; allowed: a CSV file of "
          "sites, or \"\"");
    CHECK(refusal(kMinimal + "[survey]\noccupation_min = 10\nset_ups = 4\n") ==
          "a351d.toml:11: survey.set_ups = 4: out of range; allowed: a whole number from 1 to 3");
    CHECK_THAT(refusal(kMinimal + "[verdict]\nslope = 1\n"),
               StartsWith("a351d.toml:10: verdict.slope = 1: unknown key; allowed: ") &&
                   ContainsSubstring("tilt_deg"));
    CHECK_THAT(refusal(kMinimal + "[verdict]\nshake_gal = 0.001\n"),
               StartsWith("a351d.toml:10: verdict.shake_gal = 0.001: out of range"));
    CHECK(refusal(kStation + kSensor + "[storage]\n") ==
          "a351d.toml:7: storage.root: missing; allowed: the directory for the recorded data");
}

TEST_CASE_METHOD(Fixture, "an address beyond loopback is recognised") {
    const auto page = [&](const std::string& listen) {
        return kMinimal + "[page]\nlisten = \"" + listen + "\"";
    };
    for (const char* own : {"127.0.0.1:8351", "127.0.0.2:1", "[::1]:8351", "localhost:8351"})
        CHECK(read(page(own) + "\n").page.listen.is_loopback);
    for (const char* open : {"0.0.0.0:8351", "[::]:8351"}) {
        CAPTURE(open);
        CHECK_FALSE(read(page(open) + "\n").page.listen.is_loopback);
    }
    // Nobody could read a random token.
    for (const char* one : {"192.168.7.2:8351", "[fe80::1]:8351"}) {
        CAPTURE(one);
        CHECK_FALSE(read(page(one) + "\ntoken = \"0123456789abcdef\"\n").page.listen.is_loopback);
        CHECK_THAT(refusal(page(one) + "\n"), ContainsSubstring("page.listen") &&
                                                  ContainsSubstring("or a token in page.token"));
    }
    CHECK(read(page("[::1]:65535") + "\n").page.listen.port == 65535);
    CHECK(read(page("localhost:0") + "\n").page.listen.ip == "127.0.0.1");
    for (const char* odd : {"8351", ":8351", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536",
                            "127.0.0.1:-1", "127.0.0.1:80 ", "::1:8351", "[::1]", "gravbox:8351"}) {
        CAPTURE(odd);
        CHECK_THAT(refusal(page(odd) + "\n"), ContainsSubstring("page.listen"));
    }
    for (const char* weak : {"short", "with blank and more"}) {
        CHECK_THAT(refusal(kMinimal + "[page]\ntoken = \"" + std::string(weak) + "\"\n"),
                   ContainsSubstring("page.token = "));
    }
}

TEST_CASE_METHOD(
    Fixture, "a calibration sets the response of the live signal, and keys override its warm-up") {
    unit::Calibration unit;
    unit.serial_number = "00000042";
    unit.program = "test";
    unit.valid_from = *parse_rfc3339("2026-03-01T00:00:00Z");
    unit.thermal.emplace();
    unit.thermal->values << -10.0, -15.0, 9.0, std::log(40.0), std::log(1800.0);
    unit.warm_up = unit::WarmUpGuidance{1.0, 9.0};
    std::ofstream(directory.path() / "unit.toml") << unit::to_toml(unit);
    const Config config = read(kMinimal +
                               "[survey]\ncalibration = \"unit.toml\"\n[verdict]\n"
                               "gap_s = 20\n");
    CHECK(config.verdict.static_mgal_per_degc == -10.0);
    CHECK(config.verdict.slow_mgal_per_degc == -15.0);
    CHECK(config.verdict.rate_mgal_h_per_degc == 9.0);
    CHECK(config.verdict.slow_lag_min == Approx(30.0));
    // 36 mGal at power-on decay to 1 mGal after 9 h.
    CHECK(36.0 * std::exp(-9.0 / config.verdict.warm_up_h) == Approx(1.0));
    const Config given =
        read(kMinimal + "[survey]\ncalibration = \"unit.toml\"\n[verdict]\nwarm_up_h = 3\n");
    CHECK(given.verdict.warm_up_h == 3.0);  // The explicit key wins.

    std::ofstream(directory.path() / "unit.toml") << "format = 2\n";
    CHECK_THAT(refusal(kMinimal + "[survey]\ncalibration = \"unit.toml\"\n"),
               ContainsSubstring("unit.toml:1: format = 2"));
}

TEST_CASE_METHOD(Fixture, "a host of the page is a name or an origin without a path") {
    for (const char* host : {"https://box/a351", "box/", "https://", "", "my box"}) {
        CAPTURE(host);
        CHECK_THAT(
            refusal(kMinimal + "[page]\nhosts = [\"" + host + "\"]\n"),
            ContainsSubstring("page.hosts") && ContainsSubstring("not a host name or an origin"));
    }
    const auto config =
        read(kMinimal + "[page]\nhosts = [\"laptop.local\", \"box:8080\", \"https://box:8443\"]\n");
    CHECK(config.page.hosts.size() == 3);
}
