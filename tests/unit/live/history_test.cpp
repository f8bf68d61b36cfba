#include "daemon/live/history.hpp"

#include "tests/support/catch.hpp"
#include "tests/unit/live/live_samples.hpp"

namespace a351::daemon::live {
namespace {

void take(History& history, double at_s, float value) {
    history.take(after(at_s), {value, 2.0F * value, 0.0F, -value});
}

TEST_CASE("an envelope has the least and the largest value of two seconds") {
    History history;
    for (const float value : {3.0F, 1.0F, 2.0F})
        take(history, 0.5 * static_cast<double>(value), value);
    take(history, 2.0, 7.0F);
    const auto found = history.envelopes(Channel::y, kZero, after(10.0), 100);
    REQUIRE(found.size() == 2);
    CHECK(found[0].time == kZero);
    CHECK(found[0].low == 2.0F);
    CHECK(found[0].high == 6.0F);
    CHECK(found[1].low == 14.0F);
    CHECK(history.envelopes(Channel::temperature, kZero, after(2.0), 100).at(0).low == -3.0F);
}

TEST_CASE("neighbours are merged to at most the requested number of points, and gaps stay gaps") {
    History history;
    for (int i = 0; i < 3000; ++i) {
        if (i >= 1000 && i < 2000) continue;
        take(history, 2.0 * i, static_cast<float>(i));
    }
    for (const std::size_t points : {1U, 7U, 100U, 2999U, 3000U, 4000U}) {
        const auto found = history.envelopes(Channel::x, kZero, after(6000.0), points);
        CAPTURE(points, found.size());
        CHECK(found.size() <= points);
        CHECK(found.front().low == 0.0F);
        CHECK(found.back().high == 2999.0F);
        for (std::size_t i = 1; i < found.size(); ++i)
            CHECK(found[i].time >= found[i - 1].time + from_seconds(found[i].interval_s));
    }
    const auto found = history.envelopes(Channel::x, after(1990.0), after(4010.0), 2000);
    REQUIRE(found.size() == 10);  // Five before the gap, five after it.
    CHECK(seconds_between(found[4].time, found[5].time) == 2002.0);
}

TEST_CASE("the history is a day long, and starts again from where the clock is set back") {
    History history;
    for (int i = 0; i < 50000; ++i) take(history, 2.0 * i, 1.0F);
    const auto day = history.envelopes(Channel::x, after(-10.0), after(1e6), 100000);
    CHECK(day.size() == 43201);
    take(history, 90000.0, 5.0F);
    CHECK(history.envelopes(Channel::x, after(90000.0), after(1e6), 10).size() == 1);
    CHECK(history.envelopes(Channel::x, after(1e6), after(0.0), 10).empty());
}

}  // namespace
}  // namespace a351::daemon::live
