#include "daemon/verdict/running_value.hpp"

#include <cmath>
#include <limits>
#include "tests/support/catch.hpp"

namespace a351::daemon::verdict {
namespace {

const UtcTime kRunStart{std::chrono::hours(400000)};

LiveSample sample(double at_s, double mgal) {
    LiveSample sample;
    sample.time = kRunStart + from_seconds(at_s);
    sample.seen_at = sample.time + from_seconds(10.0);
    sample.axes = {MilliGal(0.6 * mgal), MilliGal(0.0), MilliGal(0.8 * mgal)};
    sample.temperature = DegC(42.5);
    sample.shake = MilliGal(50.0);
    return sample;
}

TEST_CASE("the running value is the mean of the norm", "[verdict][running]") {
    RunningValue running({});
    running.begin_set_up(kRunStart);
    CHECK_FALSE(running.reading(MilliGal(1.0), State::stable).value);
    for (int i = 0; i < 405; ++i)
        running.take(sample(2.0 * i, 980000.0 + (i % 2 == 0 ? 1.0 : -1.0)));
    const RunningReading reading = running.reading(MilliGal(1.0), State::stable);
    CHECK(reading.value->value() == Approx(980000.0).epsilon(0.0).margin(1e-6));
    CHECK(reading.used_s == 800.0);  // The filters of the first 10 s reach back before the start.
    CHECK(reading.left_out_s == 0.0);
    // Without scatter the error of the cycle remains, 6 / sqrt 8 x 900 / (800 pi).
    CHECK(reading.standard_error->value() == Approx(0.7596).margin(1e-4));
    CHECK(reading.is_good_enough);
    CHECK(reading.needed_s == 0.0);
}

TEST_CASE("the predicted time still needed is the time that it takes", "[verdict][running]") {
    RunningValue running({});
    running.begin_set_up(kRunStart);
    const auto value_at = [](int i) { return 980000.0 + 0.8 * ((i / 30) % 2 == 0 ? 1.0 : -1.0); };
    int i = 5;
    for (; i < 155; ++i) running.take(sample(2.0 * i, value_at(i)));
    const RunningReading early = running.reading(MilliGal(0.9), State::stable);
    REQUIRE(early.needed_s);
    CHECK_FALSE(early.is_good_enough);
    const double promised_s = early.used_s + *early.needed_s;
    RunningReading reading = early;
    for (; !reading.is_good_enough; ++i) {
        running.take(sample(2.0 * i, value_at(i)));
        reading = running.reading(MilliGal(0.9), State::stable);
    }
    CHECK(reading.used_s == Approx(promised_s).margin(20.0));
}

TEST_CASE("set-ups of half the length give the error of one, and their own scatter",
          "[verdict][running]") {
    // The box is put down 3 mGal higher the second time.
    RunningValue whole({}), halves({});
    whole.begin_set_up(kRunStart);
    halves.begin_set_up(kRunStart);
    for (int i = 5; i < 365; ++i) {
        const double mgal = 980000.0 + 0.3 * ((i / 30) % 2 == 0 ? 1.0 : -1.0);
        whole.take(sample(2.0 * i, mgal));
        if (i == 185) {
            const RunningReading first = halves.reading(MilliGal(1.0), State::stable);
            CHECK(first.set_ups == 1);
            CHECK_FALSE(first.set_up_sd);
            halves.begin_set_up(kRunStart + from_seconds(360.0));
        }
        halves.take(sample(2.0 * i, i < 185 ? mgal : mgal + 3.0));
        if (i == 190) CHECK(halves.reading(MilliGal(1.0), State::stable).set_ups == 1);
    }
    const RunningReading one = whole.reading(MilliGal(1.0), State::stable),
                         two = halves.reading(MilliGal(1.0), State::stable);
    CHECK(one.used_s == 720.0);
    CHECK(two.used_s == 720.0);
    CHECK(two.set_ups == 2);
    CHECK(two.value->value() == Approx(one.value->value() + 1.5).epsilon(0.0).margin(1e-6));
    CHECK(two.set_up_sd->value() == Approx(3.0 / std::sqrt(2.0)).margin(1e-6));
    // Tables of chi squared, one degree of freedom: 5.0239 and 0.00098207.
    CHECK(two.set_up_sd_limits->front().value() == Approx(0.94643).epsilon(1e-4));
    CHECK(two.set_up_sd_limits->back().value() == Approx(67.692).epsilon(1e-4));
    CHECK(two.set_up_error->value() == Approx(1.5).margin(1e-6));
    CHECK(two.standard_error->value() == Approx(one.standard_error->value()).margin(0.01));
    CHECK(two.is_good_enough);
}

TEST_CASE("the last of several set-ups needs the time that is predicted", "[verdict][running]") {
    RunningValue running({});
    running.begin_set_up(kRunStart);
    int i = 5;
    for (; i < 185; ++i) running.take(sample(2.0 * i, 980000.0));
    CHECK(running.reading(MilliGal(1.0), State::stable).needed_s);
    running.begin_set_up(kRunStart + from_seconds(360.0));
    // A lifted box needs no more time where it was.
    CHECK_FALSE(running.reading(MilliGal(1.0), State::stable).needed_s);
    for (; i < 230; ++i) running.take(sample(2.0 * i, 980001.0));
    const RunningReading early = running.reading(MilliGal(1.0), State::stable);
    REQUIRE(early.needed_s);
    CHECK(*early.needed_s > 100.0);
    const double promised_s = early.used_s + *early.needed_s;
    RunningReading reading = early;
    for (; !reading.is_good_enough && i < 1000; ++i) {
        running.take(sample(2.0 * i, 980001.0));
        reading = running.reading(MilliGal(1.0), State::stable);
    }
    CHECK(reading.used_s == Approx(promised_s).margin(2.0));
    // The error of the first set-up alone is larger than this target.
    CHECK_FALSE(running.reading(MilliGal(0.1), State::stable).needed_s);
}

TEST_CASE("good enough requires a stable verdict and three minutes", "[verdict][running]") {
    RunningValue running({});
    running.begin_set_up(kRunStart);
    int i = 5;
    for (; i < 94; ++i) running.take(sample(2.0 * i, 980000.0));
    CHECK_FALSE(running.reading(MilliGal(5.0), State::stable).standard_error);
    for (; i < 700; ++i) running.take(sample(2.0 * i, 980000.0));
    CHECK(running.reading(MilliGal(1.0), State::stable).is_good_enough);
    const RunningReading unsettled = running.reading(MilliGal(1.0), State::settling);
    CHECK_FALSE(unsettled.is_good_enough);
    CHECK_FALSE(unsettled.needed_s);
    CHECK(unsettled.standard_error);
}

TEST_CASE("a knock and the samples it affects are left out of the running value",
          "[verdict][running]") {
    RunningValue running({});
    running.begin_set_up(kRunStart);
    for (int i = 5; i < 300; ++i) {
        // Shaken from 400 to 402 s; the filters spread it to 9 s on either side.
        LiveSample one = sample(2.0 * i, std::abs(2.0 * i - 401.0) < 10.0 ? 985000.0 : 980000.0);
        if (i == 196) one.shake = MilliGal(8000.0);  // Seen at 402 s.
        running.take(one);
    }
    const RunningReading reading = running.reading(MilliGal(1.0), State::stable);
    CHECK(reading.value->value() == Approx(980000.0).epsilon(0.0).margin(1e-6));
    CHECK(reading.left_out_s == 20.0);
}

TEST_CASE("a missing sample is left out of the running value", "[verdict][running]") {
    RunningValue running({});
    running.begin_set_up(kRunStart);
    for (int i = 5; i < 300; ++i) {
        running.take(
            sample(2.0 * i, i == 100 ? std::numeric_limits<double>::quiet_NaN() : 980000.0));
    }
    const RunningReading reading = running.reading(MilliGal(1.0), State::stable);
    CHECK(reading.value->value() == Approx(980000.0).epsilon(0.0).margin(1e-6));
    CHECK(reading.left_out_s == 2.0);
}

}  // namespace
}  // namespace a351::daemon::verdict
