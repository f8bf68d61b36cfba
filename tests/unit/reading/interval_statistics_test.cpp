#include "corrector/reading/interval_statistics.hpp"

#include "tests/unit/reading/record.hpp"

using namespace a351::corrector::eemd;

namespace a351::corrector::reading {
namespace {

TimeSeries<DegC> temperature_at_half_hertz(std::vector<double> values) {
    return {kSiteStart, Hertz(0.5), std::move(values)};
}

}  // namespace

TEST_CASE("the block standard error is the standard error of the block means") {
    const std::vector<double> values = {1, 3, 4, 6, 8, 8, 100};  // block means 2, 5, 8
    CHECK(*block_standard_error(values, 2) == Approx(std::sqrt(9.0 / 3.0)));
    CHECK_FALSE(block_standard_error(values, 4));
    CHECK_FALSE(block_standard_error({}, 4));
}

TEST_CASE("the block standard error of white noise is sigma divided by the square root of n") {
    std::vector<double> noise(300'000);
    fill_white_noise(2, 0, noise);
    // 10 000 blocks determine it to 0.7 %.
    CHECK(*block_standard_error(noise, 30) == Approx(1.0 / std::sqrt(300'000.0)).epsilon(0.03));
}

TEST_CASE("slope, range and shape of a temperature ramp are found, even with gaps") {
    std::vector<double> values(450);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = 42.5 + 0.3 * static_cast<double>(i) * 2.0 / 3600.0;
    values[200] = std::nan("");
    const auto summary = summarise_temperature(temperature_at_half_hertz(values), 100, 400);
    REQUIRE(summary);
    CHECK(summary->slope_degc_per_h == Approx(0.3));
    CHECK(summary->range.value() == Approx(300 * 0.3 * 2.0 / 3600.0));
    CHECK(summary->mean.value() == Approx(42.5 + 250 * 0.3 * 2.0 / 3600.0).epsilon(1e-6));
    CHECK(summary->shape == TemperatureShape::monotone);
}

TEST_CASE("a temperature that comes back once is half a wave, and one that moves on is turning") {
    std::vector<double> values(900);
    for (std::size_t i = 0; i < values.size(); ++i) {
        // The jitter does not count as a turn.
        values[i] = 42.5 + 0.1 * std::sin(3.14 * static_cast<double>(i) / 450.0) +
                    0.01 * std::cos(0.2 * static_cast<double>(i));
    }
    const auto series = temperature_at_half_hertz(values);
    CHECK(summarise_temperature(series, 0, 449)->shape == TemperatureShape::half_wave);
    CHECK(summarise_temperature(series, 0, 899)->shape == TemperatureShape::turning);
    CHECK(summarise_temperature(series, 0, 200)->shape == TemperatureShape::monotone);
}

TEST_CASE("fewer than two temperatures give no summary") {
    const double nan = std::nan("");
    CHECK_FALSE(summarise_temperature(temperature_at_half_hertz({nan, 1.0, nan}), 0, 2));
    CHECK(summarise_temperature(temperature_at_half_hertz({2.0, 1.0, nan}), 0, 2));
}

TEST_CASE("an axis has its mean, and its rms about the trend") {
    std::vector<double> raw(1000);
    std::vector<double> trend(10);
    for (std::size_t k = 0; k < trend.size(); ++k) trend[k] = 0.1 * static_cast<double>(k);
    for (std::size_t i = 0; i < raw.size(); ++i)
        raw[i] = 0.001 * static_cast<double>(i) + (i % 2 == 0 ? 1e-6 : -1e-6);
    const TimeSeries<StandardGravity> axis(kSiteStart, Hertz(50.0), raw);
    const TimeSeries<StandardGravity> level(kSiteStart, Hertz(0.5), trend);
    const AxisSummary summary = summarise_axis(axis, level, 100, 2, 8);
    CHECK(summary.mean.value() == Approx(0.5).epsilon(1e-6));
    CHECK(summary.rms.value() == Approx(0.980665).epsilon(1e-6));
    const AxisSummary with_gap = summarise_axis(without(axis, 300, 400), level, 100, 2, 8);
    CHECK(with_gap.rms.value() == Approx(0.980665).epsilon(1e-6));
}

}  // namespace a351::corrector::reading
