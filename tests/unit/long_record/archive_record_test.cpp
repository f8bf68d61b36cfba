#include "corrector/long_record/archive_record.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

#include "corrector/long_record/record_segments.hpp"
#include "protocol/archive/miniseed.hpp"
#include "protocol/archive/sds.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tests/unit/station/station_files.hpp"

using namespace a351;
using namespace a351::corrector::long_record;

namespace {

const UtcTime kStart = *parse_rfc3339("2026-03-01T12:00:00Z");
constexpr double kHalf_s = 600.0;
/// Sensitivity of an axis, counts per m/s2.
const std::string kValue = "<Value>1710799.9163832706</Value>";

/// A data root of a sensor at rest at 1 g and 42.476 degC.
class Root {
public:
    explicit Root(bool has_outer_oven = false) {
        auto station = station::description();
        station.has_outer_oven = has_outer_oven;
        folder_.write("metadata/station.xml", station::to_station_xml(station));
    }

    /// Adds twenty minutes of samples.
    void add() {
        add(0.0, 50.0);
        add(kHalf_s, 50.0);
    }

    /// Adds ten minutes of samples, beginning `from_s` after the start.
    void add(double from_s, double rate_hz) {
        add(from_s, rate_hz, {{"BN1", 0}, {"BN2", 0}, {"BNZ", 16'777'216}, {"BK1", -1975}});
    }

    void add(double from_s, double rate_hz,
             const std::vector<std::pair<std::string, std::int32_t>>& channels) {
        for (const auto& [channel, count] : channels) {
            archive::RecordHeader header;
            header.network = "XX";
            header.station = "A351";
            header.location = "00";
            header.channel = channel;
            header.nominal_rate = Hertz(rate_hz);
            const std::vector<std::int32_t> samples(
                static_cast<std::size_t>(std::lround(kHalf_s * rate_hz)), count);
            for (std::size_t done = 0; done < samples.size();) {
                header.start = kStart + from_seconds(from_s + static_cast<double>(done) / rate_hz);
                const auto packed = archive::pack_record(header, std::span(samples).subspan(done));
                writer_.append(channel, packed);
                done += static_cast<std::size_t>(packed.sample_count);
            }
        }
        writer_.sync();
    }

    /// Begins another epoch ten minutes after the start.
    void change(const std::string& serial_number, std::uint16_t firmware) {
        auto station = station::description();
        station.start = kStart + from_seconds(kHalf_s);
        station.serial_number = serial_number;
        station.firmware = firmware;
        text_ = station::extend_station_xml(metadata(), station).value();
        folder_.write("metadata/station.xml", text_);
    }

    /// Gives the last epoch's vertical axis twice the counts per m/s2.
    void halve_scale() {
        for (int once = 0; once < 2; ++once)  // the sensitivity of the channel and of its one stage
            text_.replace(text_.rfind(kValue), kValue.size(), "<Value>3421599.8327665412</Value>");
        folder_.write("metadata/station.xml", text_);
    }

    [[nodiscard]] LongRecord read() const {
        return read_archive_record(folder_.path(), {}, [](std::size_t, std::size_t) {});
    }

private:
    [[nodiscard]] std::filesystem::path metadata() const {
        return folder_.path() / "metadata" / "station.xml";
    }

    test::TemporaryDirectory folder_;
    std::string text_;
    archive::SdsWriter writer_{files::posix_files(), folder_.path() / "archive",
                               journal::StationCodes{}};
};

/// Returns the value in the middle of ten minutes, where the filters are filled.
double middle_mgal(const RecordStretch& stretch) { return stretch.quantity.at(15); }

}  // namespace

TEST_CASE("a new epoch with the same sensor and scales does not divide the record") {
    Root root;
    root.add();
    root.change("X0000001", 259);
    const LongRecord record = root.read();
    REQUIRE(record.stretches.size() == 1);
    CHECK(record.stretches[0].size() == 60);
    CHECK(record.stretches[0].serial_number == "X0000001");
    CHECK(record.warnings.empty());
    CHECK(middle_mgal(record.stretches[0]) ==
          Approx(980665.0).epsilon(0.0).margin(0.2));  // the tide
}

TEST_CASE("the temperature of an outer oven is read beside the record, unless it has a gap") {
    Root root(true);
    root.add();
    const LongRecord without = root.read();
    const SegmentOptions options{.shortest = 10};
    CHECK(divide_record(without, options).segments.at(0).outer_degc.empty());
    REQUIRE(without.warnings.size() == 1);
    CHECK_THAT(without.warnings[0], ContainsSubstring("outer oven has a gap"));
    root.add(0.0, 1.0, {{"LK4", 38'100}});
    root.add(kHalf_s, 1.0, {{"LK4", 38'300}});
    const LongRecord record = root.read();
    CHECK(record.warnings.empty());
    REQUIRE(record.stretches.size() == 1);
    const std::vector<double>& outer = record.stretches[0].outer_degc;
    REQUIRE(outer.size() == record.stretches[0].size());
    CHECK(outer.front() == Approx(38.1));
    CHECK(outer.back() == Approx(38.3));
    const RecordSegments parts = divide_record(record, options);
    REQUIRE(parts.segments.size() == 1);
    CHECK(parts.segments[0].outer_degc.size() == parts.segments[0].size());
}

TEST_CASE("another sensor begins a new stretch, with a warning") {
    Root root;
    root.add();
    root.change("X0000002", 258);
    const LongRecord record = root.read();
    REQUIRE(record.stretches.size() == 2);
    CHECK(record.stretches[0].size() == 30);
    CHECK(record.stretches[0].serial_number == "X0000001");
    CHECK(record.stretches[0].begins_with.empty());
    CHECK(record.stretches[1].serial_number == "X0000002");
    CHECK(record.stretches[1].begins_with == "another sensor: X0000002 after X0000001");
    CHECK(record.stretches[1].begins_with.in(*text::parse_language("ja")) ==
          "センサの交換: X0000001 から X0000002");
    CHECK(record.stretches[1].times.front() == kStart + from_seconds(kHalf_s));
    REQUIRE(record.warnings.size() == 1);
    CHECK_THAT(record.warnings[0],
               StartsWith("from 2026-03-01T12:10:00") && ContainsSubstring("another sensor"));
    const RecordSegments parts = divide_record(record, {.shortest = 10});
    REQUIRE(parts.segments.size() == 2);
    CHECK(parts.segments[1].serial_number == "X0000002");
    CHECK(parts.segments[1].begins_with == record.stretches[1].begins_with);
}

TEST_CASE("samples are scaled by the epoch they belong to") {
    Root root;
    root.add();
    root.change("X0000001", 259);
    root.halve_scale();
    const LongRecord record = root.read();
    REQUIRE(record.stretches.size() == 2);
    CHECK(record.stretches[1].begins_with == "another scale of BNZ");
    CHECK(middle_mgal(record.stretches[0]) == Approx(980665.0).epsilon(0.0).margin(0.2));
    CHECK(middle_mgal(record.stretches[1]) == Approx(490332.5).epsilon(0.0).margin(0.2));
}

TEST_CASE("another rate begins a new stretch with its own times") {
    Root root;
    root.add(0.0, 50.0);
    root.add(kHalf_s, 5.0);
    const LongRecord record = root.read();
    REQUIRE(record.stretches.size() == 2);
    CHECK(record.raw_rate_hz == 50.0);
    CHECK(record.stretches[1].size() == 30);
    CHECK(record.stretches[1].begins_with == "another rate: 5 Hz after 50 Hz");
    CHECK(record.stretches[1].times.back() == kStart + from_seconds(2.0 * kHalf_s - 20.0));
    CHECK(record.stretches[1].temperature_degc.at(15) == Approx(42.476).margin(0.001));
    CHECK(record.warnings.size() == 2);
    CHECK_THAT(record.warnings[0].english(),
               ContainsSubstring("the headers of the records say 5 Hz, the metadata 50 Hz, and "
                                 "their starts give 5.00 Hz. 5 Hz are used"));
    root.add(2.0 * kHalf_s, 52.0);
    CHECK_THROWS_AS(root.read(), InputError);
}
