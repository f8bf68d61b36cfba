#include "corrector/reading/representative_value.hpp"

#include <algorithm>

#include "tests/unit/reading/record.hpp"

namespace a351::corrector::reading {
namespace {

constexpr double kGravity = 979'951.25;

const auto kConstantLevel = [](double) { return kGravity; };
const auto kConstantTemperature = [](double) { return 42.5; };

bool has(const RepresentativeValue& value, OccupationFlag flag) {
    return std::find(value.flags.begin(), value.flags.end(), flag) != value.flags.end();
}

/// Returns the record with `pulse_mgal` added to its vertical axis from `begin_s` for `length_s`.
OccupationRecord with_pulse(OccupationRecord record, double begin_s, double length_s,
                            double pulse_mgal) {
    std::vector<double> z = record.z.values();
    for (std::size_t i = 0; i < z.size(); ++i) {
        const double t = static_cast<double>(i) / 50.0;
        if (t >= begin_s && t < begin_s + length_s)
            z[i] += pulse_mgal / kMilliGalPerStandardGravity;
    }
    record.z = TimeSeries<StandardGravity>(record.z.start(), record.z.rate(), std::move(z));
    return record;
}

}  // namespace

TEST_CASE("a constant without noise gives its value") {
    const auto value = value_of(make_record(900, kConstantLevel, kConstantTemperature));
    REQUIRE(value);
    CHECK(std::abs(value->curve_mean.value() - kGravity) < 1e-6);
    CHECK(std::abs(value->series_mean.value() - kGravity) < 1e-6);
    CHECK(value->standard_error->value() < 1e-6);
    CHECK(value->flags.empty());
    CHECK(value->temperature->mean.value() == Approx(42.5).epsilon(1e-12));
    CHECK(value->temperature->slope_degc_per_h == Approx(0.0).margin(1e-9));
    CHECK(value->temperature->range.value() < 1e-9);
    CHECK(value->counts.valid == 441);
    CHECK(value->counts.partial == 9);
    CHECK(value->counts.missing == 0);
    // Samples 5 ... 445 of 2 s.
    CHECK(value->interval_start == kSiteStart + from_seconds(10.0));
    CHECK(value->interval_end == kSiteStart + from_seconds(890.0));
}

TEST_CASE("a constant with noise gives its value within the standard error") {
    const auto value = value_of(make_record(900, kConstantLevel, kConstantTemperature, 50.0));
    REQUIRE(value);
    // 50 mGal white at 50 Hz: 50 / sqrt(44 000) = 0.24 mGal for the mean.
    REQUIRE(value->standard_error);
    CHECK(value->standard_error->value() == Approx(0.24).epsilon(0.6));
    CHECK(std::abs(value->curve_mean.value() - kGravity) < 4 * 0.24);
    CHECK(std::abs(value->curve_mean.value() - value->series_mean.value()) < 0.24);
    CHECK(value->flags.empty());
    CHECK(value->x.rms.value() == Approx(50.0).epsilon(0.02));
    CHECK(value->rectification.value() == Approx(2 * 2500.0 / (2 * kGravity)).epsilon(0.05));
    CHECK(value->z.mean.value() == Approx(kGravity / kMilliGalPerStandardGravity).epsilon(1e-5));
}

TEST_CASE("ramps of gravity and temperature give their values at mid-interval") {
    const auto record = make_record(
        1200, [](double t) { return kGravity + t / 360.0; },
        [](double t) { return 42.5 + 0.3 * t / 3600.0; }, 0.0, 100.0);
    const auto value = value_of(record);
    REQUIRE(value);
    const double middle = 600.0;  // samples 5 ... 595 of 2 s
    // Remainder of the noise that the decomposition adds, a tenth of the series' standard deviation
    // per member; four standard deviations.
    const double noise_level = 0.1 * (590.0 * 2.0 / 360.0) / std::sqrt(12.0);
    const double left_over = 4.0 * noise_level / std::sqrt(80.0 * 591.0);
    CHECK(std::abs(value->curve_mean.value() - (kGravity + middle / 360.0)) < left_over);
    CHECK(value->temperature->mean.value() == Approx(42.5 + 0.3 * middle / 3600.0).epsilon(1e-9));
    CHECK(value->temperature->slope_degc_per_h == Approx(0.3).epsilon(1e-6));
    CHECK(value->temperature->shape == TemperatureShape::monotone);
    CHECK(value->flags.empty());
}

TEST_CASE(
    "mean and slope of temperature do not depend on how long it was recorded beyond the "
    "occupation") {
    const auto degc = [](double t) { return 42.5 + 0.3 * t / 3600.0; };
    const auto alone = value_of(make_record(900, kConstantLevel, degc, 20.0, 0.0));
    for (const double lead_s : {0.02, 7.34, 60.0, 1000.0}) {
        const auto led = value_of(make_record(900, kConstantLevel, degc, 20.0, lead_s));
        CHECK(led->temperature->mean.value() == Approx(alone->temperature->mean.value()));
        CHECK(led->temperature->slope_degc_per_h == Approx(0.3).epsilon(1e-6));
    }
}

TEST_CASE("temperature on another grid is refused") {
    auto record = make_record(100, kConstantLevel, kConstantTemperature);
    record.temperature =
        TimeSeries<DegC>(kSiteStart + from_seconds(0.01), Hertz(50.0), record.temperature.values());
    CHECK_THROWS_AS(value_of(record), std::invalid_argument);
    record.temperature = TimeSeries<DegC>(kSiteStart, Hertz(25.0), record.temperature.values());
    CHECK_THROWS_AS(value_of(record), std::invalid_argument);
}

TEST_CASE("disturbed ends and a pulse do not change the value of either trend and are flagged") {
    RepresentativeOptions options{.trend = GENERATE(TrendMethod::eemd, TrendMethod::smoother)};
    const auto level = [](double t) {
        return kGravity + std::sin(2.0 * std::numbers::pi * t / 500.0);
    };
    const auto quiet = make_record(1200, level, kConstantTemperature, 20.0);
    const double pulse_mgal = GENERATE(100.0, 1000.0, 10'000.0);
    const auto mean_level = [&](const RepresentativeValue& value) {
        double sum = 0.0;
        int count = 0;
        for (UtcTime t = value.interval_start; t <= value.interval_end; t += from_seconds(2.0)) {
            sum += level(seconds_between(kSiteStart, t));
            ++count;
        }
        return sum / count;
    };
    // Noise of 1.8 mGal per 2 s sample, intervals of 5 minutes and more: 0.15 mGal for the mean.
    const double limit = 4.0 * 0.15;
    using Flag = OccupationFlag;
    const struct {
        double pulse_s;
        Flag flag, other;
        double from_s, to_s;
    } cases[]{{14.0, Flag::disturbed_start, Flag::disturbed_end, 60.0, 1200.0},
              {1170.0, Flag::disturbed_end, Flag::disturbed_start, -1.0, 1160.0},  // filters: 9.2 s
              {300.0, Flag::pulse, Flag::disturbed_end, 310.0, 1200.0}};
    for (const auto& expected : cases) {
        CAPTURE(expected.pulse_s);
        const auto value = value_of(with_pulse(quiet, expected.pulse_s, 10.0, pulse_mgal), options);
        REQUIRE(value);
        CHECK(has(*value, expected.flag));
        CHECK_FALSE(has(*value, expected.other));
        CHECK(has(*value, Flag::disturbed_start) == (expected.flag != Flag::disturbed_end));
        CHECK(value->interval_start > kSiteStart + from_seconds(expected.from_s));
        CHECK(value->interval_end < kSiteStart + from_seconds(expected.to_s));
        CHECK(std::abs(value->curve_mean.value() - mean_level(*value)) < limit);
    }
}

TEST_CASE("a record is too short if all its parts between pulses are too short") {
    const auto record = with_pulse(make_record(60, kConstantLevel, kConstantTemperature, 20.0),
                                   30.0, 0.5, 10'000.0);
    CHECK(value_of(record));  // the whole record is near an end: no pulse
    const auto at_10_hz = []<class Unit>(const TimeSeries<Unit>& series) {
        return TimeSeries<Unit>(series.start(), Hertz(10.0), series.values());
    };
    // There 60 s are six samples of the decimated series.
    CHECK_FALSE(value_of({at_10_hz(record.x), at_10_hz(record.y), at_10_hz(record.z),
                          at_10_hz(record.temperature)}));
}

TEST_CASE("a gap is not bridged: the longer part is used and the missing samples are counted") {
    auto record = make_record(900, kConstantLevel, kConstantTemperature, 20.0);
    record.y = without(record.y, 15'000, 15'004);
    const auto value = value_of(record);
    REQUIRE(value);
    CHECK(has(*value, OccupationFlag::gap));
    CHECK_FALSE(has(*value, OccupationFlag::pulse));
    // Outputs within 451 raw samples of the gap are invalid: 146 ... 154.
    CHECK(value->interval_start >= kSiteStart + from_seconds(2.0 * 155));
    CHECK(value->counts.valid == 441 - 9);
    CHECK(value->counts.valid + value->counts.partial + value->counts.missing == 450);
    record.y = without(record.y, 15'000, 25'000);
    CHECK(value_of(record)->counts.missing > 80);
}

TEST_CASE("a record of fewer than 16 valid samples is too short, one of 16 is not") {
    // 16 outputs 5 ... 20 need raw samples up to 2000 + 451.
    const auto lasting = [](double samples) {
        return value_of(make_record(samples / 50.0, kConstantLevel, kConstantTemperature, 20.0));
    };
    CHECK_FALSE(lasting(0));
    CHECK_FALSE(lasting(100));
    CHECK_FALSE(lasting(2451));
    REQUIRE(lasting(2452));
    CHECK_FALSE(lasting(2452)->standard_error);
}

TEST_CASE("a record without temperature gives no temperature and is flagged") {
    auto record = make_record(900, kConstantLevel, kConstantTemperature, 20.0);
    record.temperature = without(record.temperature, 0, record.temperature.size() - 1);
    const auto value = value_of(record);
    REQUIRE(value);
    CHECK_FALSE(value->temperature);
    CHECK(has(*value, OccupationFlag::no_temperature));
}

TEST_CASE("the norm in the published order contains the rectification bias that is reported") {
    const auto level = make_record(900, kConstantLevel, kConstantTemperature);
    const OccupationRecord record = {vibrating_axis(45'000, 0.0, 1.0, 7.3),
                                     vibrating_axis(45'000, 0.0, 1.0, 11.9), level.z,
                                     level.temperature};
    const auto published = value_of(record, {.norm = NormOrder::as_published});
    const auto ours = value_of(record);
    CHECK(ours->curve_mean.value() == Approx(kGravity).margin(1e-3).epsilon(0));
    CHECK(published->curve_mean.value() - ours->curve_mean.value() ==
          Approx(published->rectification.value()).epsilon(0.01));
    CHECK(ours->rectification.value() == Approx(1.02).margin(0.01));
}

TEST_CASE("both trends are averaged over one interval, and the requested trend gives the value") {
    const auto level = [](double t) {
        return kGravity + 3.0 * std::sin(2.0 * std::numbers::pi * t / 900.0);
    };
    auto record = make_record(1200, level, kConstantTemperature, 20.0);
    RepresentativeOptions options;
    const auto by_eemd = value_of(record, options);
    options.trend = TrendMethod::smoother;
    const auto by_smoother = value_of(record, options);
    CHECK(by_eemd->curve_mean == by_eemd->eemd_mean);
    CHECK(by_smoother->curve_mean == by_smoother->smoother_mean);
    // An undisturbed record is used completely with either curve.
    CHECK(by_smoother->eemd_mean == by_eemd->eemd_mean);
    CHECK(by_smoother->smoother_mean == by_eemd->smoother_mean);
    CHECK(by_smoother->curve.values() != by_eemd->curve.values());
    // White noise of 20 mGal at 50 Hz in 591 samples of 2 s, correlated by the filters: 0.08 mGal.
    CHECK(by_smoother->smoother_standard_error.value() == Approx(0.08).epsilon(0.2));
    CHECK(std::abs(by_smoother->smoother_mean.value() - by_smoother->series_mean.value()) < 0.02);

    double squares = 0.0;
    const auto& curve = by_smoother->curve;
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const double seconds = seconds_between(kSiteStart, curve.time_of(static_cast<double>(i)));
        const double error = curve.values()[i] - level(seconds);
        squares += error * error / static_cast<double>(curve.size());
    }
    CHECK(std::sqrt(squares) < 0.5);  // the wave has an amplitude of 3
}

TEST_CASE("in the smoother's trend a wave of the cut-off period has half its height") {
    const auto level = [](double t) {
        return kGravity + 4.0 * std::sin(2.0 * std::numbers::pi * t / 100.0);
    };
    const auto value = value_of(make_record(1200, level, kConstantTemperature),
                                {.trend = TrendMethod::smoother, .cutoff_s = 100.0});
    const auto& curve = value->curve.values();
    const auto middle = curve.begin() + static_cast<std::ptrdiff_t>(curve.size() / 2);
    const auto [least, most] = std::minmax_element(middle - 50, middle + 50);
    CHECK(*most - *least == Approx(4.0).epsilon(0.01));
}

TEST_CASE("a value of the smoother is flagged if its weights did not converge") {
    // Levels of 2 s each. None of them is a disturbance, but the smoother's weights alternate.
    const std::vector<double> levels = {5, 36, 7, 1, 2, 9, 4, 1, 58, 11, 2, 20, 9, 5, 1, 1,  7, 6,
                                        5, 45, 0, 9, 2, 3, 3, 6, 6,  0,  2, 9,  6, 9, 2, 18, 5};
    const auto level = [&](double t) {
        return levels[std::min(static_cast<std::size_t>(t / 2.0), levels.size() - 1)];
    };
    const auto record = make_record(70, level, kConstantTemperature);
    RepresentativeOptions options{.cutoff_s = 24.0};
    CHECK_FALSE(has(*value_of(record, options), OccupationFlag::unsettled));
    options.trend = TrendMethod::smoother;
    CHECK(has(*value_of(record, options), OccupationFlag::unsettled));
}

TEST_CASE("a cut-off outside its range is refused") {
    const auto record = make_record(100, kConstantLevel, kConstantTemperature);
    CHECK_THROWS_AS(value_of(record, {.cutoff_s = 501.0}), std::invalid_argument);
}

TEST_CASE("every flag has the same name as in the enumeration") {
    CHECK(flag_name(OccupationFlag::fallback) == "fallback");
    CHECK(flag_name(OccupationFlag::disturbed_start) == "disturbed_start");
    CHECK(flag_name(OccupationFlag::disturbed_end) == "disturbed_end");
    CHECK(flag_name(OccupationFlag::pulse) == "pulse");
    CHECK(flag_name(OccupationFlag::gap) == "gap");
    CHECK(flag_name(OccupationFlag::no_temperature) == "no_temperature");
    CHECK(flag_name(OccupationFlag::unsettled) == "unsettled");
}

}  // namespace a351::corrector::reading
