#include "daemon/store/clock_watch.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using daemon::store::ClockWatch;
using std::chrono::seconds;

TEST_CASE("each step of the host's clock that the sample times follow is reported") {
    ClockWatch watch;
    timing::ClockReading reading;
    reading.realtime = *parse_rfc3339("2026-03-01T12:00:00Z");
    reading.is_synchronised = true;
    std::vector<double> steps;
    const auto run = [&](int readings) {
        for (int i = 0; i < readings; ++i) {
            reading.raw += seconds(1);
            reading.boottime += seconds(1);
            reading.realtime += seconds(1);
            const auto step = watch.observe(reading);
            if (!step) continue;
            CHECK(step->after == reading.realtime);
            steps.push_back(seconds_between(step->before, step->after));
        }
    };
    run(600);
    CHECK(steps.empty());
    for (const int step_s : {3600, -3600, -80}) {
        reading.realtime += seconds(step_s);
        run(7200);
    }
    REQUIRE(steps.size() == 3);
    for (std::size_t i = 0; i < 3; ++i)
        CHECK(steps[i] == Approx(std::array{3600.0, -3600.0, -80.0}.at(i)).margin(0.01));

    // The host sleeps: its clock continues, so there is no step.
    reading.boottime += seconds(500);
    reading.realtime += seconds(500);
    run(600);
    CHECK(steps.size() == 3);

    reading.leap = timing::LeapSecond::inserted;
    run(10);
    reading.realtime -= seconds(1);
    run(600);
    CHECK(steps.size() == 3);
}
