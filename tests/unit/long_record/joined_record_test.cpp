#include "corrector/long_record/joined_record.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

#include "corrector/long_record/csv_record.hpp"
#include "corrector/long_record/record_segments.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::corrector::long_record;

namespace {

/// Returns a record read from a CSV with rows from `from_s` to `to_s`.
LongRecord part(double step_s, double from_s, double to_s, bool has_axes = false) {
    const test::TemporaryDirectory folder;
    std::string text = has_axes ? "time_s,x_g,y_g,z_g,temperature_degc\n"
                                : "time_s,acceleration_mgal,temperature_degc\n";
    const auto count = static_cast<int>(std::lround((to_s - from_s) / step_s));
    for (int i = 0; i < count; ++i) {
        const double time_s = from_s + step_s * i, wave = std::sin(time_s / 143.0);
        const std::string value = std::to_string(0.577 + 1e-6 * wave);  // of each axis
        text +=
            std::to_string(time_s) + "," +
            (has_axes ? value + "," + value + "," + value : std::to_string(979763.0 + 3.0 * wave)) +
            "," + std::to_string(42.5 + 0.01 * wave) + "\n";
    }
    const std::string name = "from-" + std::to_string(std::lround(from_s)) + ".csv";
    return read_csv_record(folder.write(name, text), {}, [](std::size_t, std::size_t) {});
}

LongRecord joined(LongRecord first, LongRecord second) {
    std::vector<LongRecord> parts;
    parts.push_back(std::move(first));
    parts.push_back(std::move(second));
    return joined_record(std::move(parts));
}

}  // namespace

TEST_CASE("a night cut into two files is one segment") {
    // The files may be in any order, and some samples may be missing at the cut.
    for (const double missing_s : {0.0, 300.0}) {
        const LongRecord record =
            joined(part(20.0, 21600.0 + missing_s, 43200.0), part(20.0, 0.0, 21600.0));
        CAPTURE(missing_s);
        REQUIRE(record.stretches.size() == 1);
        CHECK(record.stretches[0].size() == 2160);
        CHECK(record.inputs.size() == 2);
        const RecordSegments parts = divide_record(record);
        REQUIRE(parts.segments.size() == 1);
        CHECK(parts.segments[0].size() == 2160);
        CHECK(parts.segments[0].bridged == static_cast<std::size_t>(missing_s / 20.0));
        CHECK(seconds_between(parts.segments[0].start, parts.segments[0].end) == 43180.0);
    }
}

TEST_CASE("joined parts have the temperature of an outer oven if all have it, else a warning") {
    LongRecord first = part(20.0, 0.0, 21600.0), second = part(20.0, 21900.0, 43200.0);
    for (LongRecord* const record : {&first, &second})
        record->stretches[0].outer_degc.assign(record->stretches[0].size(), 38.0);
    const LongRecord both = joined(first, second);
    CHECK(both.stretches.at(0).outer_degc == std::vector<double>(2160, 38.0));
    second.stretches[0].outer_degc.clear();
    for (const LongRecord& record : {joined(first, second), joined(second, first)}) {
        const std::vector<double>& degc = record.stretches.at(0).outer_degc;
        REQUIRE(degc.size() == record.stretches[0].size());
        CHECK(std::ranges::count(degc, 38.0) == 1095);  // the first part and the bridge of 300 s
        CHECK(divide_record(record).segments.at(0).outer_degc.empty());
        CHECK(record.warnings.size() == both.warnings.size() + 1);
    }
}

TEST_CASE("two files with a longer gap between them are two segments") {
    const RecordSegments parts =
        divide_record(joined(part(20.0, 0.0, 21600.0), part(20.0, 21920.0, 43200.0)));
    REQUIRE(parts.segments.size() == 2);
    CHECK(parts.segments[1].begins_with == "gap of 340 s");
}

TEST_CASE("decimated files are joined across the ends of their filters") {
    const LongRecord record =
        joined(part(2.0, 0.0, 21600.0, true), part(2.0, 21600.0, 43200.0, true));
    REQUIRE(record.stretches.size() == 1);
    CHECK(record.stretches[0].size() == 2160);
    CHECK(record.stretches[0].raw.size() == 2160);
    CHECK(record.stretches[0].axes_mgal[2].size() == 2160);
    const RecordSegments parts = divide_record(record);
    REQUIRE(parts.segments.size() == 1);
    CHECK(parts.segments[0].bridged > 0);
}

TEST_CASE("files with different steps, and files that overlap, are refused") {
    CHECK_THROWS_WITH(joined(part(20.0, 0.0, 4000.0), part(21.0, 4000.0, 8200.0)),
                      ContainsSubstring("from-4000.csv: a sample every 21 s, ") &&
                          ContainsSubstring("from-0.csv has one every 20 s; "));
    CHECK_THROWS_WITH(joined(part(20.0, 0.0, 4000.0), part(20.0, 3980.0, 8000.0)),
                      ContainsSubstring("from-3980.csv: at ") &&
                          ContainsSubstring("Z it overlaps ") && ContainsSubstring("from-0.csv; "));
}

TEST_CASE("a record whose clock was set back is refused with the remedy") {
    LongRecord record = part(20.0, 0.0, 4000.0);
    record.stretches.push_back(part(20.0, 3000.0, 8000.0).stretches.front());
    CHECK_THROWS_WITH(joined_record({record}), ContainsSubstring("from-0.csv: instants from ") &&
                                                   ContainsSubstring("occur twice") &&
                                                   ContainsSubstring("retime"));
}
