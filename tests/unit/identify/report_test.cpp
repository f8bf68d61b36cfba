#include "daemon/identify/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "protocol/wire/profile_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/identify/made_up_sensor.hpp"

namespace a351::daemon::identify {
namespace {

Line line_of(const Report& report, const std::string& topic) {
    const auto found = std::ranges::find(report.lines, topic, &Line::topic);
    REQUIRE(found != report.lines.end());
    return *found;
}

Report report_of(const MadeUpSensor& sensor = {}) {
    return report_on(sensor.observe(), expected_a351());
}

/// Requires that only one topic differs, and returns its sentence.
std::string only_difference(const Report& report, const std::string& topic) {
    for (const Line& line : report.lines) {
        INFO(line.topic << ": " << line.finding);
        CHECK((line.verdict == Verdict::differs) == (line.topic == topic));
    }
    return line_of(report, topic).finding;
}

}  // namespace

TEST_CASE("a sensor that agrees with its configuration is confirmed in each point") {
    const Report report = report_of();
    for (const Line& line : report.lines) {
        INFO(line.topic << ": " << line.finding);
        // The configuration names no serial number.
        CHECK(line.verdict ==
              (line.topic == "serial number" ? Verdict::unseen : Verdict::confirmed));
    }
    CHECK_FALSE(report.differs());
    CHECK(report.profile == "A351");
    CHECK_FALSE(report.toml);
    CHECK(report.sensor == "sensor A351AU10, serial number 00000042, firmware 7, at /dev/ttyUSB0");
    CHECK_THAT(to_text(report),
               ContainsSubstring("confirmed      rate: 50.000 frames a second, expected 50"));
    CHECK_THAT(advice(report, "A351", "stem"), ContainsSubstring("profile A351 fits\n"));
    CHECK_THAT(
        to_text(report),
        ContainsSubstring("the values of profile A351, which is not verified, are from\n") &&
            ContainsSubstring("\n  temperature: assumed: as the M-A352AD10; its data sheet") &&
            ContainsSubstring("\n  filter: assumed: as the M-A352AD10"));
}

TEST_CASE("another product of the family gets the profile that is shipped for it") {
    MadeUpSensor sensor;
    sensor.product = "A352AD10";
    const Report report = report_of(sensor);
    CHECK_THAT(only_difference(report, "product"), ContainsSubstring("begin with A351"));
    CHECK(report.profile == "A352AD10");
    CHECK_FALSE(report.toml);
    CHECK_THAT(advice(report, "A351", "stem"),
               ContainsSubstring("set sensor.profile = \"A352AD10\""));
}

TEST_CASE("an unknown product gets a profile of its own") {
    MadeUpSensor sensor;
    sensor.product = "B999XY00";
    const Report report = report_of(sensor);
    REQUIRE(report.toml);
    const auto profile = wire::parse_profile(*report.toml, "mine", "mine.toml");
    CHECK(profile.product_id == "B999XY00");
    CHECK(profile.product_id_prefix == "B999XY00");
    CHECK_FALSE(profile.is_verified);
    CHECK_THAT(advice(report, "A351", "stem"),
               ContainsSubstring("set sensor.profile = \"stem.toml\""));
}

TEST_CASE("a scale that is a power of 2 away is named, and is in the profile that fits") {
    for (const int excess : {-2, -1, 1, 2}) {
        MadeUpSensor sensor;
        sensor.change = [&](int, wire::BurstValues& values) {
            for (std::int32_t& axis : values.axes)
                axis = static_cast<std::int32_t>(std::lround(std::ldexp(axis, excess)));
        };
        const Report report = report_of(sensor);
        CHECK_THAT(
            only_difference(report, "norm"),
            ContainsSubstring("acceleration.fraction_bits = " + std::to_string(24 + excess)));
        REQUIRE(report.toml);
        const auto profile = wire::parse_profile(*report.toml, "mine", "mine.toml");
        CHECK(profile.acceleration_fraction_bits == 24 + excess);
        CHECK(profile.tilt_fraction_bits == 29);
    }
    MadeUpSensor odd;
    odd.change = [](int, wire::BurstValues& values) {
        for (std::int32_t& axis : values.axes) axis = axis / 10 * 7;
    };
    const Report report = report_of(odd);
    CHECK_THAT(only_difference(report, "norm"), ContainsSubstring("no scale of the family fits"));
    CHECK(report.profile.empty());
    CHECK_FALSE(report.toml);
    Expected lower = expected_a351();
    lower.gravity = StandardGravity(0.999);
    CHECK_THAT(line_of(report_on(MadeUpSensor{}.observe(), lower), "norm").finding,
               ContainsSubstring("1.00002 g, +1.02 mg from normal gravity"));
}

TEST_CASE("a bias of 40 mg is no other scale, and for a box that moves no profile fits") {
    MadeUpSensor sensor;
    sensor.change = [](int, wire::BurstValues& values) { values.axes[2] += (1 << 24) / 25; };
    CHECK(line_of(report_of(sensor), "norm").verdict == Verdict::confirmed);
    sensor.change = [](int i, wire::BurstValues& values) { values.axes[2] += (i % 100) << 14; };
    const Report moved = report_of(sensor);
    CHECK(line_of(moved, "norm").verdict == Verdict::unseen);
    CHECK(moved.profile.empty());
}

TEST_CASE("a start-up test whose result is not known is not confirmed") {
    Observation seen = MadeUpSensor().observe();
    seen.start_up_test = wire::StartUpTest::unknown;
    CHECK(line_of(report_on(seen, expected_a351()), "start-up test").verdict == Verdict::unseen);
}

TEST_CASE("each format of the temperature is named from 7.5 to 60 degC by the profile A351") {
    struct Format {
        double slope_degc, offset_degc;
        int noise_counts;
    };
    // One count of a sensor of 16 bits, of the same with 16 more bits, and of counts / 1024.
    const std::array formats{Format{-0.0037918, 34.987, 1},
                             Format{-0.0037918 / 65536, 34.987, 65536}, Format{1.0 / 1024, 0.0, 4}};
    for (std::size_t sent = 0; sent < formats.size(); ++sent) {
        for (double degc = 0.0; degc <= 60.0; degc += 2.5) {
            const Format& format = formats.at(sent);
            // Below 7.2 degC the counts of both formats are ambiguous: those of the A352AD10, read
            // as counts / 1024, give the temperature of a cold room, and the reverse.
            if (degc < 7.5 && sent != 1) continue;
            MadeUpSensor sensor;
            sensor.change = [&](int i, wire::BurstValues& values) {
                const double counts = (degc - format.offset_degc) / format.slope_degc;
                values.temperature = static_cast<std::int32_t>(std::lround(counts)) +
                                     (i % 3 - 1) * format.noise_counts;
            };
            const Report report = report_of(sensor);
            INFO(sent << ", " << degc << " degC: " << line_of(report, "temperature").finding);
            if (sent == 0) {
                CHECK_FALSE(report.differs());
                continue;
            }
            static_cast<void>(only_difference(report, "temperature"));
            REQUIRE(report.toml);
            const auto profile = wire::parse_profile(*report.toml, "mine", "mine.toml");
            CHECK(profile.temperature_slope_degc == format.slope_degc);
            CHECK(profile.temperature_offset_degc == format.offset_degc);
        }
    }
}

TEST_CASE("a temperature of 0 counts, or of no sample, is dead, and a quiet oven is not") {
    for (const std::int32_t counts : {0, -1, -1981}) {
        MadeUpSensor sensor;
        sensor.change = [&](int, wire::BurstValues& values) { values.temperature = counts; };
        const Report report = report_of(sensor);
        CHECK(report.differs() == (counts != -1981));
        CHECK_THAT(line_of(report, "temperature").finding,
                   ContainsSubstring(counts == -1981 ? "profile A351: 42.50 degC; for the counts N"
                                                     : "none of them is possible"));
    }
}

TEST_CASE("an axis that is dead, and one that is not the vertical one, are named") {
    MadeUpSensor sensor;
    sensor.change = [](int, wire::BurstValues& values) { values.axes[0] = 0; };
    CHECK_THAT(only_difference(report_of(sensor), "noise of x"), ContainsSubstring("dead"));
    sensor.change = [](int, wire::BurstValues& values) {
        std::swap(values.axes[0], values.axes[2]);
    };
    CHECK_THAT(only_difference(report_of(sensor), "vertical axis"),
               ContainsSubstring("x, 0.3 degrees from the vertical; sensor.axes calls z Z"));
    Expected without_z = expected_a351();
    without_z.axes = {"1", "2", "3"};
    CHECK(line_of(report_on(sensor.observe(), without_z), "vertical axis").verdict ==
          Verdict::unseen);
}

TEST_CASE("another rate, another tick and late frames are told apart") {
    MadeUpSensor slow;
    slow.rate_hz = 49.0;
    const Report rate = report_of(slow);
    CHECK(line_of(rate, "rate").verdict == Verdict::differs);
    CHECK(line_of(rate, "tick").verdict == Verdict::differs);

    MadeUpSensor other;
    other.count_step = 40;
    CHECK_THAT(only_difference(report_of(other), "tick"),
               ContainsSubstring("COUNT rises by 40 a frame, 2000.0 a second"));

    Observation late = MadeUpSensor{}.observe();  // The first and the last frames arrive late.
    for (std::size_t k = 0; k < late.reads.size(); ++k)
        if (k < 20 || k + 20 > late.reads.size())
            late.reads[k].time += std::chrono::milliseconds(300);
    late.reads[0].time -= std::chrono::milliseconds(300);
    CHECK_FALSE(report_on(late, expected_a351()).differs());
}

TEST_CASE("lost frames do not change the rate, and damaged ones are counted") {
    Observation seen = MadeUpSensor{}.observe();
    seen.bytes[24 * 1000 + 7] ^= std::byte{1};
    const Report report = report_on(seen, expected_a351());
    CHECK_THAT(only_difference(report, "frames"),
               ContainsSubstring("2499 of 24 bytes each; 24 bytes are not understood"));
}

TEST_CASE("baud rate, serial number, start-up test and silent registers are compared") {
    Observation seen = MadeUpSensor{}.observe();
    seen.baud = 230400;
    CHECK(only_difference(report_on(seen, expected_a351()), "baud rate") ==
          "230400, expected 460800");
    seen = MadeUpSensor{}.observe();
    seen.start_up_test = wire::StartUpTest::hard_error;
    CHECK_THAT(only_difference(report_on(seen, expected_a351()), "start-up test"),
               ContainsSubstring("HARD_ERR"));
    seen = MadeUpSensor{}.observe();
    CHECK_THAT(line_of(report_on(seen, expected_a351()), "registers").finding,
               ContainsSubstring(" answered") && !ContainsSubstring("repeated"));
    seen.repeated_reads = 2;
    CHECK_THAT(line_of(report_on(seen, expected_a351()), "registers").finding,
               ContainsSubstring(
                   " answered; reads repeated because an answer was late, lost or wrong: 2"));
    seen.repeated_reads = 0;
    seen.registers[3].value.reset();
    CHECK(only_difference(report_on(seen, expected_a351()), "registers") == "no answer from FLAG");
    seen = MadeUpSensor{}.observe();
    Expected expected = expected_a351();
    expected.serial_number = "00000042";
    CHECK(line_of(report_on(seen, expected), "serial number").verdict == Verdict::confirmed);
    expected.serial_number = "00000043";
    CHECK(only_difference(report_on(seen, expected), "serial number") ==
          "00000042, expected 00000043");
}

TEST_CASE("without frames the reason is shown, and what needs frames cannot be seen") {
    Observation seen = MadeUpSensor{}.observe();
    seen.trouble = "SMPL_CTRL: expected 0x0600, found 0x0400";
    seen.bytes.clear();
    seen.reads.clear();
    const Report report = report_on(seen, expected_a351());
    CHECK(only_difference(report, "settings") == seen.trouble);
    CHECK(line_of(report, "frames").verdict == Verdict::unseen);
    CHECK(line_of(report, "temperature").verdict == Verdict::unseen);

    seen.trouble.clear();
    CHECK(only_difference(report_on(seen, expected_a351()), "frames") == "no byte arrived");
}

TEST_CASE("a sensor that is refused before it is asked for its name has no profile") {
    Observation seen;
    seen.port = "/dev/ttyUSB0";
    seen.baud = 460800;
    seen.has_answered = true;
    seen.trouble = "GLOB_CMD: not ready after 3000 ms";
    const Report report = report_on(seen, expected_a351());
    CHECK(only_difference(report, "settings") == seen.trouble);
    CHECK(report.profile.empty());
    CHECK_FALSE(report.toml);
    CHECK_THAT(advice(report, "A351", "stem"),
               ContainsSubstring("no profile is known that fits\n"));
}

TEST_CASE("silence, text and other bytes have different explanations") {
    Observation seen;
    seen.port = "/dev/ttyUSB0, 115200 baud";
    CHECK_THAT(explain_silence(seen), ContainsSubstring("no answer at any baud rate"));
    seen.heard = "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n";
    CHECK_THAT(explain_silence(seen), ContainsSubstring("(\"$GPGGA,123519,4807.038,N") &&
                                          ContainsSubstring("GPS receiver") &&
                                          !ContainsSubstring("\\x0D"));
    const Observation sensor = MadeUpSensor{}.observe();
    seen.heard.clear();
    for (std::size_t i = 0; i < 24; ++i) seen.heard.push_back(static_cast<char>(sensor.bytes[i]));
    CHECK_FALSE(is_text(seen.heard));
    CHECK_THAT(explain_silence(seen), ContainsSubstring("none can be understood"));
}

}  // namespace a351::daemon::identify
