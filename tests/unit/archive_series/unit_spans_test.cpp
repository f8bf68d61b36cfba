#include "corrector/archive_series/unit_spans.hpp"

#include "tests/support/catch.hpp"

#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::corrector::archive_series;
using namespace std::chrono_literals;

namespace {

const UtcTime kNoon = parse_rfc3339("2026-03-01T12:00:00Z").value();

/// Returns the spans of a station whose sensors began at these times.
std::vector<UnitSpan> spans_of(const std::vector<std::pair<UtcTime, std::string>>& sensors) {
    const test::TemporaryDirectory folder;
    const auto file = folder.path() / "station.xml";
    station::Description description;
    description.profile = "A351";
    description.output_rate_hz = 50;
    description.filter = "k512_fc9";
    for (const auto& [start, serial_number] : sensors) {
        description.start = start;
        description.serial_number = serial_number;
        if (!std::filesystem::exists(file))
            folder.write("station.xml", station::to_station_xml(description));
        else if (const auto text = station::extend_station_xml(file, description))
            folder.write("station.xml", *text);
    }
    return read_unit_spans(file);
}

/// Returns the samples of an hour at 1 Hz.
archive::Segment hour_from(UtcTime start) {
    return {1.0, std::vector<std::int32_t>(3600), {{0, start}}};
}

}  // namespace

TEST_CASE("a sensor that comes back has two spans, and other changes begin none") {
    const auto spans =
        spans_of({{kNoon, "A"}, {kNoon + 1h, "B"}, {kNoon + 2h, "B"}, {kNoon + 3h, "A"}});
    REQUIRE(spans.size() == 3);
    CHECK(spans[0].from == UtcTime::min());
    CHECK(spans[0].to == kNoon + 1h);
    CHECK(spans[1].serial_number == "B");
    CHECK(spans[1].to == kNoon + 3h);
    CHECK(spans[2].serial_number == "A");
    CHECK(spans[2].to == UtcTime::max());
    CHECK(span_at(spans, kNoon - 24h).serial_number == "A");
    CHECK(span_at(spans, kNoon + 1h - 2s).serial_number == "A");
    CHECK(span_at(spans, kNoon + 1h - 500ms).serial_number == "B");
    CHECK(span_at(spans, kNoon + 100h).serial_number == "A");
}

TEST_CASE("a time without a serial number belongs to the sensor before it") {
    CHECK(spans_of({{kNoon, "A"}, {kNoon + 1h, ""}, {kNoon + 2h, "A"}}).size() == 1);
    const auto later = spans_of({{kNoon, ""}, {kNoon + 1h, "A"}});
    REQUIRE(later.size() == 1);
    CHECK(later[0].serial_number == "A");
    CHECK(spans_of({{kNoon, ""}})[0].serial_number.empty());
}

TEST_CASE("the samples of other sensors are removed, those of the box's outer oven are not") {
    const auto spans = spans_of({{kNoon, "A"}, {kNoon + 1h, "B"}});
    std::vector<archive::ChannelData> samples(5);
    for (archive::ChannelData& channel : samples)
        channel.segments = {hour_from(kNoon - 10s), hour_from(kNoon + 1h)};
    keep_unit(samples, spans, "A");
    for (std::size_t channel = 0; channel <= kTemperature; ++channel) {
        REQUIRE(samples[channel].segments.size() == 1);
        CHECK(samples[channel].segments[0].anchors[0].time == kNoon - 10s);
    }
    CHECK(samples[kOuter].segments.size() == 2);
}
