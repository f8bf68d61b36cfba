#include "daemon/verdict/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include "tests/support/catch.hpp"

namespace a351::daemon::verdict {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const UtcTime kStart{std::chrono::hours(400000)};

/// A settled box at rest, changed by the tests.
class Series {
public:
    double degc = 42.6, slope_degc_per_h = 0.0;
    double shake_mgal = 60.0, x_mgal = 0.0, noise_mgal = 0.5, drift_mgal_per_h = 0.0;

    explicit Series(const Options& options = {}) : judge(options) {}

    /// Gives the judge the samples of a time, each of them changed by `change`.
    template <class Change>
    const Verdict& run(double seconds, Change change) {
        for (const double end_s = now_s_ + seconds; now_s_ < end_s; now_s_ += 2.0) {
            LiveSample sample = next();
            change(sample);
            judge.take(sample);
        }
        return judge.verdict();
    }
    const Verdict& run(double seconds) {
        return run(seconds, [](LiveSample&) {});
    }
    [[nodiscard]] const Reason* find(std::string_view quantity) const {
        const auto& reasons = judge.verdict().reasons;
        const auto found = std::ranges::find(reasons, quantity, &Reason::quantity);
        return found == reasons.end() ? nullptr : &*found;
    }

    LiveSample next() {
        degc += slope_degc_per_h * 2.0 / 3600.0;
        LiveSample sample;
        sample.time = kStart + from_seconds(now_s_);
        sample.seen_at = sample.time + from_seconds(10.0);
        const bool is_odd = ++count_ % 2 != 0;
        sample.axes = {MilliGal(x_mgal), MilliGal(0.0),
                       MilliGal(980000.0 + drift_mgal_per_h * now_s_ / 3600.0 +
                                (is_odd ? noise_mgal : -noise_mgal))};
        // The oven's cycle, and the last digit of a sensor that works.
        sample.temperature = DegC(degc + 0.008 * std::sin(2.0 * std::numbers::pi * now_s_ / 900.0) +
                                  (is_odd ? 1e-4 : -1e-4));
        sample.shake = MilliGal(shake_mgal);
        return sample;
    }

    void skip(double seconds) { now_s_ += seconds; }
    [[nodiscard]] UtcTime now() const { return kStart + from_seconds(now_s_ + 10.0); }

    Judge judge;

private:
    double now_s_ = 0.0;
    int count_ = 0;
};

/// A series that has been at rest for an hour.
struct SettledSeries : Series {
    SettledSeries() { run(3600.0); }
};

TEST_CASE("without a sample the verdict is no data, with the reason") {
    Judge judge;
    const Verdict& verdict = judge.at(kStart);
    CHECK(verdict.state == State::no_data);
    CHECK(verdict.lack == Lack::values);
    CHECK(verdict.since == kStart);
    REQUIRE(verdict.reasons.size() == 1);
    CHECK(verdict.reasons[0].to_message() == "values so far (the first takes 20 s): 0 (needs 1)");
}

TEST_CASE(
    "a settled oven is stable, despite its cycle, once its temperature is known for long enough") {
    Series series;
    CHECK(series.run(600.0).state == State::settling);
    const Verdict early = series.judge.verdict();
    const Reason* known = series.find("temperature known for");
    REQUIRE(known != nullptr);
    CHECK(known->value == Approx(10.0).margin(0.5));
    CHECK_FALSE(known->is_met);
    // At least the rest of the 20 min, and then the hold.
    CHECK(early.time_left_s.value() == Approx(600.0 + 20.0).margin(30.0));

    Series knocked = series;  // A disturbance is listed before what is not known yet.
    knocked.shake_mgal = 5000.0;
    CHECK(knocked.run(4.0).state == State::disturbed);
    CHECK(knocked.judge.verdict().reasons.front().quantity == std::string("last knock"));
    CHECK_FALSE(knocked.find("temperature known for")->is_met);

    CHECK(series.run(900.0).state == State::stable);
    CHECK(series.judge.verdict().time_left_s == 0.0);
    const UtcTime since = series.judge.verdict().since;
    CHECK(series.run(3600.0).state == State::stable);
    CHECK(series.judge.verdict().since == since);
    for (const Reason& reason : series.judge.verdict().reasons) CHECK(reason.is_met);
}

TEST_CASE_METHOD(
    SettledSeries,
    "a moving temperature gives the verdict settling, with slope and change as numbers") {
    slope_degc_per_h = 0.5;
    const Verdict& verdict = run(1800.0);
    CHECK(verdict.state == State::settling);
    const Reason& first = verdict.reasons.front();
    CHECK_FALSE(first.is_met);
    // The filter assumes that every ramp ends, and attributes part of the cycle to it.
    CHECK(find("temperature slope")->value == Approx(0.5).margin(0.15));
    CHECK(find("temperature slope")->to_message().english().find("degC/h (limit") !=
          std::string::npos);
    const double change_mgal = find("reading will change in 10 min by")->value;
    CHECK(change_mgal < -2.0);  // A rising temperature lowers the reading.
    CHECK_FALSE(verdict.time_left_s);

    slope_degc_per_h = 0.0;
    CHECK(run(2400.0).state == State::stable);
}

TEST_CASE("becoming stable requires more certainty than staying stable") {
    Options options;
    options.sure_stay = 0.2;
    Series settling(options);
    settling.slope_degc_per_h = 0.15;
    CHECK(settling.run(7200.0).state == State::settling);

    Series stable(options);
    stable.run(3600.0);
    for (int i = 1; i <= 15; ++i) {
        stable.slope_degc_per_h = 0.01 * i;
        CHECK(stable.run(600.0).state == State::stable);
    }
    stable.slope_degc_per_h = 0.4;
    CHECK(stable.run(1800.0).state == State::settling);
}

TEST_CASE_METHOD(SettledSeries,
                 "a sudden change of the temperature slope is detected within 150 s") {
    slope_degc_per_h = 1.0;
    double waited_s = 0.0;
    for (; run(10.0).state == State::stable; waited_s += 10.0) REQUIRE(waited_s < 600.0);
    CHECK(judge.verdict().state == State::settling);
    CHECK(waited_s < 150.0);
}

TEST_CASE_METHOD(
    SettledSeries,
    "a knock disturbs for a minute, a hand at the box for as long as an opened lid has an effect") {
    shake_mgal = 5000.0;
    const auto [length_s, quiet_s] = GENERATE(std::pair(4.0, 72.0), std::pair(20.0, 110.0));
    CHECK(run(length_s).state == State::disturbed);
    CHECK_FALSE(judge.verdict().reasons.front().is_met);
    shake_mgal = 60.0;
    CHECK(run(quiet_s - 4.0).state == State::disturbed);
    CHECK(run(8.0).state == State::stable);
}

TEST_CASE_METHOD(SettledSeries, "weak shaking disturbs only while it lasts, and is not a knock") {
    shake_mgal = 1900.0;
    CHECK(run(20.0).state == State::disturbed);
    CHECK(find("last knock") == nullptr);
    shake_mgal = 60.0;
    CHECK(run(12.0).state == State::stable);
}

TEST_CASE("shaking of a ground that is never quiet becomes its usual level") {
    Series series;
    series.shake_mgal = 900.0;
    CHECK(series.run(3600.0).state == State::stable);
    series.shake_mgal = 1500.0;
    CHECK(series.run(4.0).state == State::disturbed);
}

TEST_CASE_METHOD(SettledSeries, "a knock ends when the shaking is back at its usual level") {
    shake_mgal = 5000.0;
    run(2.0);
    shake_mgal = 1000.0;
    run(2.0);
    shake_mgal = 60.0;
    run(70.0);
    CHECK(find("last knock")->value == Approx(70.0));
    CHECK(find("box last touched") == nullptr);
}

TEST_CASE_METHOD(SettledSeries, "after a hand at the box the predicted change is less certain") {
    const double before = find("reading will change in 10 min by")->error;
    shake_mgal = 5000.0;
    run(20.0);
    const double after = find("reading will change in 10 min by")->error;
    std::printf("error of the change: %.2f mGal, after a hand %.2f mGal\n", before, after);
    CHECK(after > 2.0 * before);
    shake_mgal = 60.0;
    run(1200.0);
    CHECK(find("reading will change in 10 min by")->error < 1.2 * before);
}

TEST_CASE("a reading that drifts at steady temperature is not stable, and its slope is given") {
    Series series;
    series.drift_mgal_per_h = 30.0;
    const Verdict& verdict = series.run(3600.0);
    CHECK(verdict.state == State::settling);
    const Reason* slope = series.find("acceleration slope");
    REQUIRE(slope != nullptr);
    CHECK_FALSE(slope->is_met);
    CHECK(slope->value == Approx(30.0).margin(0.5));
    CHECK(slope->error < 1.0);
    CHECK(slope->to_message().english().rfind("acceleration slope 30 +- ", 0) == 0);

    Series slow;
    slow.drift_mgal_per_h = 5.0;
    CHECK(slow.run(3600.0).state == State::stable);

    Options options;
    options.history_min = 60.0;  // Longer than the 40 min that a slope needs.
    Series patient(options);
    patient.drift_mgal_per_h = 30.0;
    patient.run(3500.0);
    CHECK(patient.find("acceleration slope") == nullptr);
    patient.run(400.0);
    CHECK(patient.find("acceleration slope") != nullptr);
    CHECK(patient.judge.verdict().state == State::settling);
}

TEST_CASE_METHOD(SettledSeries, "a changed tilt counts as a hand at the box") {
    x_mgal = 300.0;  // 0.0175 degrees: within the tolerance.
    CHECK(run(120.0).state == State::stable);
    x_mgal = 1000.0;
    CHECK(run(10.0).state == State::disturbed);
    CHECK(find("box last touched") != nullptr);
    CHECK(run(300.0).state == State::stable);
}

TEST_CASE_METHOD(SettledSeries, "noise far above its usual level gives the verdict disturbed") {
    noise_mgal = 10.0;
    CHECK(run(120.0).state == State::disturbed);
    CHECK(find("noise")->value == Approx(10.0).margin(0.5));
    noise_mgal = 0.5;
    CHECK(run(120.0).state == State::stable);
}

TEST_CASE("a cold box is warming up, also for hours after it is warm") {
    Series series;
    series.degc = 40.0;
    series.slope_degc_per_h = 5.0;
    CHECK(series.run(1500.0).state == State::warming_up);
    series.run(300.0);
    series.slope_degc_per_h = 0.0;  // 42.5 degC from here on, half an hour after the first sample.
    CHECK(series.run(1800.0).state == State::warming_up);
    CHECK(series.find("switched on")->value == Approx(1.0).margin(0.01));
    CHECK(series.run(10000.0).state == State::stable);
}

TEST_CASE("a box that is colder after a gap was switched off") {
    constexpr const char* kAgain = "the box was switched off, and on again";
    Series series;
    series.run(14400.0);
    series.skip(3600.0);
    series.degc = 41.4;
    series.slope_degc_per_h = 3.0;
    CHECK(series.run(1200.0).state == State::warming_up);
    REQUIRE(series.find(kAgain) != nullptr);
    CHECK(series.find(kAgain)->value == Approx(1.0 / 3.0).margin(0.01));

    // A box that was cold before the gap, or is warm after it, was not switched off.
    for (const auto& [before_degc, after_degc] : {std::pair{41.2, 40.8}, {43.2, 42.4}}) {
        Series other;
        other.degc = before_degc;
        other.run(1200.0);
        other.skip(600.0);
        other.degc = after_degc;
        other.run(1200.0);
        CHECK(other.find(kAgain) == nullptr);
    }
}

TEST_CASE_METHOD(
    SettledSeries,
    "a gap above its limit is no data, and after a long gap steadiness must be shown again") {
    const UtcTime last = now() - from_seconds(2.0);
    CHECK(judge.at(last + from_seconds(9.0)).state == State::stable);
    const Verdict& verdict = judge.at(last + from_seconds(11.0));
    CHECK(verdict.state == State::no_data);
    CHECK(verdict.lack == Lack::values);
    CHECK(verdict.since == last + from_seconds(10.0));
    CHECK(verdict.reasons.front().to_message().english().rfind("last good sample", 0) == 0);

    skip(60.0);
    CHECK(run(30.0).state == State::stable);
    skip(1200.0);
    CHECK(run(30.0).state == State::settling);
    CHECK(run(1500.0).state == State::stable);
}

TEST_CASE_METHOD(SettledSeries, "values that are not numbers count as no data") {
    const bool is_axis = GENERATE(true, false);
    const auto spoil = [is_axis](LiveSample& sample) {
        if (is_axis)
            sample.axes[1] = MilliGal(kNan);
        else
            sample.temperature = DegC(kNan);
    };
    CHECK(run(20.0, spoil).state == State::no_data);
    CHECK(run(60.0).state == State::stable);
}

TEST_CASE_METHOD(SettledSeries, "a stuck temperature counts as no data, a gap does not stick") {
    const UtcTime stuck = now();
    const auto stick = [](LiveSample& sample) { sample.temperature = DegC(42.6); };
    // A quiet oven changes by one count in two minutes.
    CHECK(run(600.0, stick).state == State::stable);
    CHECK(run(20.0, stick).state == State::no_data);
    CHECK(judge.verdict().lack == Lack::changes);
    CHECK(judge.verdict().since == stuck + from_seconds(600.0));
    CHECK(find("temperature unchanged for") != nullptr);
    CHECK(run(30.0).state == State::stable);

    Options options;
    options.gap_s = 600.0;
    Series series(options);
    series.run(3600.0);
    CHECK(series.judge.at(series.now() + from_seconds(185.0)).state == State::stable);
}

TEST_CASE_METHOD(SettledSeries, "time that goes backwards starts the history again") {
    skip(-1800.0);
    CHECK(run(60.0).state == State::settling);
    CHECK(run(1500.0).state == State::stable);
}

}  // namespace
}  // namespace a351::daemon::verdict
