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

TEST_CASE("the running value is the mean of the norm") {
    RunningValue running({});
    running.begin_set_up(kRunStart);
    CHECK_FALSE(running.reading().value);
    for (int i = 0; i < 405; ++i)
        running.take(sample(2.0 * i, 980000.0 + (i % 2 == 0 ? 1.0 : -1.0)));
    const RunningReading reading = running.reading();
    CHECK(reading.value->value() == Approx(980000.0).epsilon(0.0).margin(1e-6));
    CHECK(reading.used_s == 800.0);  // The filters of the first 10 s reach back before the start.
    CHECK(reading.left_out_s == 0.0);
}

TEST_CASE("set-ups of half the length give the mean of one, and their own scatter") {
    // The box is put down 3 mGal higher the second time.
    RunningValue whole({}), halves({});
    whole.begin_set_up(kRunStart);
    halves.begin_set_up(kRunStart);
    for (int i = 5; i < 365; ++i) {
        const double mgal = 980000.0 + 0.3 * ((i / 30) % 2 == 0 ? 1.0 : -1.0);
        whole.take(sample(2.0 * i, mgal));
        if (i == 185) {
            const RunningReading first = halves.reading();
            CHECK(first.set_ups == 1);
            CHECK_FALSE(first.set_up_sd);
            halves.begin_set_up(kRunStart + from_seconds(360.0));
        }
        halves.take(sample(2.0 * i, i < 185 ? mgal : mgal + 3.0));
        if (i == 190) CHECK(halves.reading().set_ups == 1);
    }
    const RunningReading one = whole.reading(), two = halves.reading();
    CHECK(one.used_s == 720.0);
    CHECK(two.used_s == 720.0);
    CHECK(two.set_ups == 2);
    CHECK(two.value->value() == Approx(one.value->value() + 1.5).epsilon(0.0).margin(1e-6));
    CHECK(two.set_up_sd->value() == Approx(3.0 / std::sqrt(2.0)).margin(1e-6));
    // Tables of chi squared, one degree of freedom: 5.0239 and 0.00098207.
    CHECK(two.set_up_sd_limits->front().value() == Approx(0.94643).epsilon(1e-4));
    CHECK(two.set_up_sd_limits->back().value() == Approx(67.692).epsilon(1e-4));
    CHECK(two.set_up_error->value() == Approx(1.5).margin(1e-6));
}

TEST_CASE("a knock, the samples it affects and missing ones are left out of the running value") {
    RunningValue running({});
    running.begin_set_up(kRunStart);
    for (int i = 5; i < 300; ++i) {
        // Shaken from 400 to 402 s; the filters spread it to 9 s on either side.
        LiveSample one = sample(2.0 * i, std::abs(2.0 * i - 401.0) < 10.0 ? 985000.0 : 980000.0);
        if (i == 196) one.shake = MilliGal(8000.0);  // Seen at 402 s.
        if (i == 100) one = sample(2.0 * i, std::numeric_limits<double>::quiet_NaN());
        running.take(one);
    }
    const RunningReading reading = running.reading();
    CHECK(reading.value->value() == Approx(980000.0).epsilon(0.0).margin(1e-6));
    CHECK(reading.left_out_s == 20.0 + 2.0);
}

}  // namespace
}  // namespace a351::daemon::verdict
