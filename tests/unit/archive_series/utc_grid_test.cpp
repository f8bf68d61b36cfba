#include "corrector/archive_series/utc_grid.hpp"

#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include "tests/support/catch.hpp"

namespace a351::corrector::archive_series {
namespace {

const UtcTime kStart = *parse_rfc3339("2026-03-01T12:00:00.013Z");
constexpr double kAmplitude = 1e8;  // counts; rounding to counts adds 1e-8 of it

/// Returns two minutes of a sine from a clock that is `ppm` fast, in records of 500 samples.
archive::Segment sine(double frequency_hz, double ppm, double offset = 0.0) {
    archive::Segment segment;
    segment.rate_hz = 50.0;
    const double true_rate_hz = 50.0 * (1.0 + 1e-6 * ppm);
    for (int i = 0; i < 6000; ++i) {
        const double t = i / true_rate_hz;
        if (i % 500 == 0)
            segment.anchors.push_back({static_cast<std::size_t>(i), kStart + from_seconds(t)});
        segment.counts.push_back(static_cast<std::int32_t>(std::lround(
            offset + kAmplitude * std::sin(2.0 * std::numbers::pi * frequency_hz * t))));
    }
    return segment;
}

/// Returns the largest deviation from the sine at the grid times, relative to the amplitude.
double error(const GridRun& run, int rate_hz, double frequency_hz) {
    double largest = 0.0;
    for (std::size_t i = 0; i < run.values.size(); ++i) {
        const double t =
            seconds_between(kStart, grid_time(run.first + static_cast<std::int64_t>(i), rate_hz));
        const double expected = kAmplitude * std::sin(2.0 * std::numbers::pi * frequency_hz * t);
        largest = std::max(largest, std::abs(run.values[i] - expected));
    }
    return largest / kAmplitude;
}

GridRun resampled(const archive::Segment& segment, const UtcGrid& grid) {
    return grid.resample(segment, kStart - std::chrono::hours(1), kStart + std::chrono::hours(1));
}

}  // namespace

TEST_CASE("grid times are whole multiples of the period, also before 1970") {
    CHECK(to_rfc3339(grid_time(50 * 86400LL + 1, 50), 3) == "1970-01-02T00:00:00.020Z");
    CHECK(to_rfc3339(grid_time(-1, 50), 3) == "1969-12-31T23:59:59.980Z");
    CHECK(to_rfc3339(grid_time(4, 3), 9) == "1970-01-01T00:00:01.333333333Z");
    for (const int rate_hz : {1, 3, 50}) {
        const std::int64_t k = first_on_grid(kStart, rate_hz);
        CHECK(grid_time(k, rate_hz) >= kStart);
        CHECK(grid_time(k - 1, rate_hz) < kStart);
        CHECK(first_on_grid(grid_time(k, rate_hz), rate_hz) == k);
    }
}

TEST_CASE("sines up to 0.4 of the grid rate are reproduced within 1e-5 from a clock 100 ppm off") {
    for (const int rate_hz : {50, 10, 1}) {
        const UtcGrid grid(50.0, rate_hz);
        for (const double share : {0.001, 0.1, 0.2, 0.3, 0.4}) {
            const double frequency_hz = share * rate_hz;
            const GridRun run = resampled(sine(frequency_hz, 100.0), grid);
            const double found = error(run, rate_hz, frequency_hz);
            WARN(rate_hz << " Hz, sine of " << frequency_hz << " Hz: largest error " << found);
            CHECK(found < 1e-5);
            CHECK(run.values.size() > 50);
        }
    }
}

TEST_CASE("frequencies that the lower rate cannot represent are reduced to 1e-4") {
    const UtcGrid grid(50.0, 10);
    for (const double frequency_hz : {6.0, 8.0, 14.0}) {
        double largest = 0.0;
        for (const double value : resampled(sine(frequency_hz, 20.0), grid).values)
            largest = std::max(largest, std::abs(value));
        WARN("10 Hz, sine of " << frequency_hz << " Hz: " << largest / kAmplitude << " is left");
        CHECK(largest / kAmplitude < 1e-4);
    }
}

TEST_CASE("a constant is unchanged on the grid") {
    archive::Segment segment = sine(1.0, 20.0);
    for (auto& count : segment.counts) count = 16'777'215;
    for (const double value : resampled(segment, UtcGrid(50.0, 50)).values)
        CHECK(std::abs(value - 16'777'215.0) < 1e-9);
}

TEST_CASE(
    "no value is computed if its filter reaches outside the segment, or outside the "
    "requested range") {
    const archive::Segment segment = sine(1.0, 0.0);
    const UtcGrid grid(50.0, 50);
    const GridRun all = resampled(segment, grid);
    CHECK(all.values.size() == 5999 - 64);  // The grid lies between the samples.
    CHECK(seconds_between(kStart, grid_time(all.first, 50)) == Approx(0.64).margin(0.02));
    const UtcTime from = kStart + std::chrono::seconds(10);
    const GridRun part = grid.resample(segment, from, from + std::chrono::seconds(2));
    CHECK(part.values.size() == 100);
    CHECK(grid_time(part.first, 50) >= from);
    archive::Segment shortest = segment;
    shortest.counts.resize(64);
    shortest.anchors.resize(1);
    CHECK(resampled(shortest, grid).values.empty());
}

TEST_CASE("a rate above that of the samples is refused") {
    CHECK_THROWS_AS(UtcGrid(50.0, 51), std::invalid_argument);
    CHECK_THROWS_AS(UtcGrid(50.0, 0), std::invalid_argument);
}

}  // namespace a351::corrector::archive_series
