#include "daemon/believable/rate_watch.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/wrong_sensor.hpp"

namespace a351::daemon::believable {
namespace {

constexpr int kNominalHz = 50;

/// Plays samples at a rate that arrive at once.
struct Arrivals {
    void play(double seconds, double rate_hz) {
        const double end_s = now_s + seconds;
        for (; now_s < end_s; now_s += 1.0 / rate_hz)
            watch.take(index++, RawTime(from_seconds(now_s)));
    }
    RateWatch watch{kNominalHz};
    double now_s = 0.0;
    std::int64_t index = 0;
};

TEST_CASE("a rate that is 2 % off is named within a minute, one that is 0.4 % off is not") {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        for (const double error : {0.02, -0.02}) {
            const auto named_s = sim::rate_named_after_s(error, seed);
            REQUIRE(named_s);
            CHECK(*named_s <= 60.0);
        }
        for (const double error : {0.004, 0.0, -0.004})
            CHECK_FALSE(sim::rate_named_after_s(error, seed));
    }
}

TEST_CASE("the rate is named as it is, and while it is wrong") {
    Arrivals arrivals;
    arrivals.play(60.0, 51.0);
    REQUIRE(arrivals.watch.wrong_rate());
    CHECK(std::abs(arrivals.watch.wrong_rate()->value() - 51.0) < 0.02);
    CHECK(rate_trouble(Hertz(51.0), kNominalHz)
              .english()
              .starts_with("the sensor sends 51.0 samples/s, but output_rate_hz is 50"));
    arrivals.play(60.0, 50.0);
    CHECK_FALSE(arrivals.watch.wrong_rate());
}

TEST_CASE("samples that waited, or were lost, are not another rate") {
    for (const std::int64_t jump : {500, -500}) {
        Arrivals arrivals;
        arrivals.play(30.0, 50.0);
        arrivals.index += jump;
        for (int second = 0; second < 120; ++second) {
            arrivals.play(1.0, 50.0);
            CHECK_FALSE(arrivals.watch.wrong_rate());
        }
    }
}

TEST_CASE("samples that waited in a gap and come at once are not another rate") {
    Arrivals arrivals;
    arrivals.play(30.0, 50.0);
    arrivals.now_s += 70.0;
    arrivals.index += 70 * kNominalHz - 100;
    for (int read = 0; read < 10; ++read) {
        arrivals.index += 10;
        arrivals.watch.take(arrivals.index, RawTime(from_seconds(arrivals.now_s)));
        CHECK_FALSE(arrivals.watch.wrong_rate());
    }
}

}  // namespace
}  // namespace a351::daemon::believable
