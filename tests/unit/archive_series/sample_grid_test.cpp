#include "corrector/archive_series/sample_grid.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::archive_series;
using namespace std::chrono_literals;

namespace {

const UtcTime kGridStart = parse_rfc3339("2020-01-01T00:00:00Z").value();
const station::ChannelScale kScale{"BNZ", 2.0, 1.0, "m/s**2"};

/// Returns `count` samples at `rate_hz` with the values first + i and a time stamp every 500.
archive::Segment segment(UtcTime start, double rate_hz, std::size_t count, std::int32_t first) {
    archive::Segment result;
    result.rate_hz = 50.0;
    for (std::size_t i = 0; i < count; ++i) {
        result.counts.push_back(first + static_cast<std::int32_t>(i));
        if (i % 500 == 0)
            result.anchors.push_back({i, start + from_seconds(static_cast<double>(i) / rate_hz)});
    }
    return result;
}

std::size_t missing(const std::vector<double>& values) {
    std::size_t count = 0;
    for (const double value : values) {
        if (std::isnan(value)) ++count;
    }
    return count;
}

}  // namespace

TEST_CASE("a window has the samples from its start up to, but not including, its end") {
    const std::vector<archive::Segment> segments{segment(kGridStart - 1s, 50.0, 10'000, 0)};
    const auto grid = sampling_grid(segments, kGridStart, kGridStart + 100s).value();
    CHECK(grid.origin == kGridStart);
    CHECK(grid.count == 5000);
    const auto values = place_on_grid(segments, kScale, grid);
    CHECK(missing(values) == 0);
    CHECK(values.front() == 1.0 + 2.0 * 50);
    CHECK(values.back() == 1.0 + 2.0 * 5049);
}

TEST_CASE("a sensor off its nominal rate loses no samples and keeps its times") {
    const double ppm = GENERATE(-80.0, 0.0, 80.0);
    CAPTURE(ppm);
    const double rate_hz = 50.0 * (1.0 + 1e-6 * ppm);
    const std::vector<archive::Segment> segments{segment(kGridStart, rate_hz, 45'000, 0)};
    const auto grid = sampling_grid(segments, kGridStart, kGridStart + 1000s).value();
    CHECK(grid.rate_hz == Approx(rate_hz).epsilon(1e-8));
    const auto values = place_on_grid(segments, kScale, grid);
    for (std::size_t i = 0; i < 45'000; ++i) {
        if (values[i] != 1.0 + 2.0 * static_cast<double>(i)) FAIL("sample " << i);
    }
    CHECK(missing(values) == values.size() - 45'000);
}

TEST_CASE("a gap becomes missing samples of the same length") {
    const std::vector<archive::Segment> segments{
        segment(kGridStart, 50.0, 4000, 0), segment(kGridStart + 80s + 60ms, 50.0, 1000, 4003)};
    const auto grid = sampling_grid(segments, kGridStart, kGridStart + 100s).value();
    const auto values = place_on_grid(segments, kScale, grid);
    CHECK(missing(values) == 3);
    CHECK(values[3999] == 1.0 + 2.0 * 3999);
    CHECK(std::isnan(values[4000]));
    CHECK(values[4003] == 1.0 + 2.0 * 4003);
}

TEST_CASE("a window without samples has no sampling grid") {
    const std::vector<archive::Segment> segments{segment(kGridStart, 50.0, 100, 0)};
    CHECK_FALSE(sampling_grid(segments, kGridStart + 10s, kGridStart + 20s).has_value());
    CHECK_FALSE(sampling_grid(segments, kGridStart - 20s, kGridStart).has_value());
    CHECK_FALSE(sampling_grid({}, kGridStart, kGridStart + 20s).has_value());
}

TEST_CASE("where samples overlap, the later segment in the list counts") {
    const std::vector<std::int32_t> earlier{1, 2, 3}, later{10, 20};
    std::vector<double> values(5, 7.0);
    fill(values, 100, {{earlier, 99}, {later, 101}, {later, 110}}, 2.0, 0.5);
    CHECK(values[0] == 4.5);
    CHECK(values[1] == 20.5);
    CHECK(values[2] == 40.5);
    CHECK(missing(values) == 2);
}
