#include <cmath>
#include <limits>

#include "tests/unit/long_record/simulated_record.hpp"

using namespace a351;
using namespace a351::corrector::long_record;

namespace {

const UtcTime kSegmentStart = *parse_rfc3339("2026-03-01T00:00:00Z");

/// Returns a simulated night as one stretch.
LongRecord night() {
    const RecordSegment segment = simulated_segment("indoor", 1);
    RecordStretch stretch;
    for (std::size_t i = 0; i < segment.size(); ++i)
        stretch.times.push_back(kSegmentStart +
                                from_seconds(kRecordStep_s * static_cast<double>(i)));
    stretch.quantity = segment.quantity;
    stretch.temperature_degc = segment.temperature_degc;
    LongRecord record;
    record.stretches.push_back(std::move(stretch));
    return record;
}

void erase(LongRecord& record, std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
        record.stretches[0].quantity[i] = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

TEST_CASE("a quiet night is one segment") {
    const RecordSegments parts = divide_record(night());
    REQUIRE(parts.segments.size() == 1);
    CHECK(parts.segments[0].size() == 2160);
    CHECK(parts.segments[0].bridged == 0);
    CHECK(parts.refused.empty());
}

TEST_CASE("short gaps and knocks are bridged, long gaps divide the record") {
    LongRecord record = night();
    erase(record, 200, 215);
    erase(record, 1000, 1016);
    record.stretches[0].quantity[500] += 1000.0;
    const RecordSegments parts = divide_record(record);
    REQUIRE(parts.segments.size() == 2);
    CHECK(parts.segments[0].size() == 1000);
    CHECK(parts.segments[0].bridged == 16);
    CHECK(parts.segments[0].disturbed == 1);
    CHECK(std::abs(parts.segments[0].quantity[500] - parts.segments[0].quantity[499]) < 5.0);
    CHECK(parts.segments[1].begins_with == "gap of 340 s");
    CHECK_FALSE(parts.segments[1].is_restart);
}

TEST_CASE("a step of the acceleration divides the record at the step") {
    LongRecord record = night();
    for (std::size_t i = 900; i < 2160; ++i) record.stretches[0].quantity[i] += 60.0;
    const RecordSegments parts = divide_record(record);
    REQUIRE(parts.segments.size() == 2);
    CHECK(parts.segments[0].size() == 900);
    CHECK_THAT(parts.segments[1].begins_with, StartsWith("step of ") && EndsWith(" mGal"));
}

TEST_CASE("a power cycle is recognised as a restart by the temperature change across the gap") {
    LongRecord record = night();
    erase(record, 1000, 1090);
    for (std::size_t i = 1000; i < 2160; ++i)
        record.stretches[0].temperature_degc[i] -=
            0.6 * std::exp(-(static_cast<double>(i) - 1000.0) / 200.0);
    const RecordSegments parts = divide_record(record);
    REQUIRE(parts.segments.size() == 2);
    CHECK(parts.segments[1].is_restart);
    CHECK_THAT(parts.segments[1].begins_with, EndsWith("a restart"));
}

TEST_CASE("values that no sensor sends are refused with the remedy") {
    LongRecord record = night();
    RecordStretch& stretch = record.stretches[0];
    stretch.axes_mgal.resize(3);
    for (std::size_t i = 0; i < stretch.size(); ++i) {
        const double wiggle = static_cast<double>(i % 7);  // so that no axis is stuck
        stretch.axes_mgal[0].push_back(wiggle);
        stretch.axes_mgal[1].push_back(wiggle);
        stretch.axes_mgal[2].push_back((i < 500 ? 0.5 : 1.0) * 980'000.0 + wiggle);
        if (i >= 1500) stretch.temperature_degc[i] += 100.0;
    }
    const RecordSegments parts = divide_record(record);
    REQUIRE(parts.segments.size() == 1);
    CHECK(parts.segments[0].size() == 1000);
    CHECK(parts.segments[0].start == stretch.times[500]);
    CHECK(parts.segments[0].begins_with == "the record begins");
    REQUIRE(parts.refused.size() == 2);
    CHECK(parts.refused[0].end == stretch.times[499]);
    CHECK_THAT(parts.refused[0].reason, StartsWith("the acceleration reads 0.50 g: no sensor"));
    CHECK(parts.refused[1].start == stretch.times[1500]);
    CHECK(parts.refused[1].end == stretch.times.back());
    CHECK_THAT(parts.refused[1].reason, StartsWith("the temperature reads 142.") &&
                                            ContainsSubstring("a351-correct retime --profile"));
}

TEST_CASE(
    "a stuck temperature is refused with its value, and so is a remainder that is too short") {
    LongRecord record = night();
    for (std::size_t i = 1000; i < 2000; ++i) record.stretches[0].temperature_degc[i] = 42.5;
    const RecordSegments parts = divide_record(record);
    REQUIRE(parts.segments.size() == 1);
    CHECK(parts.segments[0].size() == 1000);
    REQUIRE(parts.refused.size() == 2);
    CHECK(parts.refused[0].reason == "the temperature is stuck at 42.5000 degC");
    CHECK_THAT(parts.refused[1].reason,
               StartsWith("too short: 0.89 h") && ContainsSubstring("end of the refused values"));
}

TEST_CASE("a coarse thermometer in a good oven is not stuck, but one that continues elsewhere is") {
    LongRecord record = night();
    auto& temperature = record.stretches[0].temperature_degc;
    // An oven that moves by 0.02 degC in six hours, seen in steps of 0.01 degC.
    for (std::size_t i = 0; i < temperature.size(); ++i)
        temperature[i] =
            42.5 + 0.01 * std::round(2.0 * std::sin(static_cast<double>(i) * 6.28 / 1080.0));
    const RecordSegments parts = divide_record(record);
    REQUIRE(parts.segments.size() == 1);
    CHECK(parts.refused.empty());
    CHECK(parts.segments[0].size() == 2160);

    for (std::size_t i = 900; i < 1200; ++i) temperature[i] = temperature[900];
    const RecordSegments stuck = divide_record(record);
    REQUIRE(stuck.refused.size() >= 1);
    CHECK(stuck.refused[0].reason == "the temperature is stuck at 42.4800 degC");

    for (double& value : temperature) value = 42.5;
    CHECK(divide_record(record).segments.empty());
}

TEST_CASE(
    "a record without samples, a dead sensor and a stuck acceleration give no segment, and "
    "what is stuck is named") {
    LongRecord empty = night(), dead = night(), stuck = night();
    erase(empty, 0, 2160);
    CHECK(divide_record(empty).segments.empty());
    dead.stretches[0].axes_mgal.assign(3, std::vector<double>(2160, 0.0));
    stuck.stretches[0].quantity.assign(2160, 979763.0);
    for (const auto& [record, count, reason] :
         {std::tuple(dead, 3U, "the x axis is stuck at 0.0000 mGal"),
          {stuck, 1U, "the acceleration is stuck at 979763.0000 mGal"}}) {
        const RecordSegments parts = divide_record(record);
        CHECK(parts.segments.empty());
        REQUIRE(parts.refused.size() == count);
        CHECK(parts.refused[0].reason == reason);
    }
}

TEST_CASE("a stuck axis is refused, even if a changing tide was taken off the norm") {
    LongRecord record = night();
    RecordStretch& stretch = record.stretches[0];
    stretch.axes_mgal.assign(3, stretch.quantity);
    for (double& z_mgal : stretch.axes_mgal[2]) z_mgal += 979763.0;
    CHECK(divide_record(record).segments.size() == 1);
    stretch.axes_mgal[2].assign(2160, 979763.0);
    for (std::size_t i = 0; i < 2160; ++i)
        stretch.quantity[i] = 979763.0 - 0.1 * std::sin(static_cast<double>(i) / 700.0);
    const RecordSegments parts = divide_record(record);
    CHECK(parts.segments.empty());
    REQUIRE(parts.refused.size() == 1);
    CHECK(parts.refused[0].reason == "the z axis is stuck at 979763.0000 mGal");
}
