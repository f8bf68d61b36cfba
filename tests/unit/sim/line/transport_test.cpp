#include "sim/line/transport.hpp"

#include <chrono>
#include <cmath>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::sim::line;
using namespace a351::sim::scenario;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t kFrame = 24;

struct Passage {
    UtcTime arrives, shown;
};

/// Carries frames at 50 Hz and fetches each as soon as it is shown.
std::vector<Passage> carry(const LineParameters& parameters, int frames, std::uint64_t seed = 1) {
    Transport transport(parameters, seed, UtcTime(0s));
    std::vector<Passage> passages;
    for (int i = 0; i < frames; ++i) {
        const UtcTime arrives = UtcTime(i * 20ms);
        transport.carry(kFrame, arrives);
        const UtcTime shown = transport.shown_at(kFrame);
        REQUIRE(transport.next_shown() == shown);
        REQUIRE(transport.shown(shown - 1ns) == 0);
        REQUIRE(transport.shown(shown) == kFrame);
        transport.take(kFrame);
        passages.push_back({arrives, shown});
    }
    return passages;
}

std::vector<double> delays_ms(const std::vector<Passage>& passages) {
    std::vector<double> delays;
    for (const Passage& each : passages) {
        delays.push_back(1e3 * seconds_between(each.arrives, each.shown));
    }
    return delays;
}

}  // namespace

TEST_CASE("bytes are never shown early or out of order") {
    LineParameters parameters;
    parameters.latency_timer_ms = 16.0;
    parameters.latency_timer_ppm = 30.0;
    parameters.usb_poll_ms = 1.0;
    parameters.jitter_ms = 30.0;
    parameters.stall_per_h = 60.0;
    parameters.stall_s = {0.1, 3.0};
    const auto passages = carry(parameters, 50 * 3600);
    for (std::size_t i = 1; i < passages.size(); ++i) {
        REQUIRE(passages[i].shown >= passages[i].arrives);
        REQUIRE(passages[i].shown >= passages[i - 1].shown);
    }
}

TEST_CASE("a 16 ms timer delays a 20 ms stream by four values that repeat") {
    // 16 ms and 20 ms share 4 ms: the delay repeats every four frames (locked beat).
    LineParameters parameters;
    parameters.latency_timer_ms = 16.0;
    const auto delays = delays_ms(carry(parameters, 400));
    double sum = 0.0;
    for (std::size_t i = 4; i < delays.size(); ++i) {
        CHECK(delays[i] == Approx(delays[i - 4]).margin(1e-5));
        CHECK((delays[i] >= 0.0 && delays[i] < 16.0));
        sum += delays[i];
    }
    // Mean of phi, phi + 4, phi + 8, phi + 12 with phi in [0, 4).
    const double mean = sum / static_cast<double>(delays.size() - 4);
    CHECK((mean > 5.9 && mean < 10.1));
}

TEST_CASE("a timer that drifts gives all delays") {
    LineParameters parameters;
    parameters.latency_timer_ms = 16.0;
    parameters.latency_timer_ppm = 30.0;
    // The beat of 4 ms passes in 4 ms / 30 ppm = 133 s: an hour has 27 of them.
    const auto delays = delays_ms(carry(parameters, 50 * 3600));
    double sum = 0.0, least = 16.0, most = 0.0;
    for (const double delay : delays) {
        sum += delay;
        least = std::min(least, delay);
        most = std::max(most, delay);
    }
    CHECK(sum / static_cast<double>(delays.size()) == Approx(8.0).margin(0.1));
    CHECK(least < 0.01);
    CHECK(most > 15.98);
}

TEST_CASE("polls lie on a grid, and jitter stays below its limit") {
    LineParameters parameters;
    parameters.usb_poll_ms = 1.0;
    const auto polled = carry(parameters, 1000);
    for (const Passage& each : polled) {
        CHECK(each.shown - each.arrives <= 1ms);
        CHECK(std::fmod(1e3 * seconds_between(polled[0].shown, each.shown) + 0.5, 1.0) ==
              Approx(0.5).margin(1e-5));
    }
    parameters.usb_poll_ms = 0.0;
    parameters.jitter_ms = 2.0;
    double sum = 0.0;
    for (const double delay : delays_ms(carry(parameters, 5000))) {
        CHECK((delay >= 0.0 && delay <= 2.0));
        sum += delay;
    }
    CHECK(sum / 5000 == Approx(1.0).margin(0.05));  // 6 sigma of a uniform mean.
}

TEST_CASE("stalls have the requested rate and length") {
    LineParameters parameters;
    parameters.stall_per_h = 120.0;
    parameters.stall_s = {0.1, 0.2};
    const int hours = 5;
    int stalls = 0;
    UtcTime stall_end;
    for (const Passage& each : carry(parameters, 50 * 3600 * hours)) {
        if (each.shown == each.arrives) continue;
        CHECK(each.shown - each.arrives <= 200ms);
        if (each.shown != stall_end) ++stalls;
        stall_end = each.shown;
    }
    CHECK(std::abs(stalls - 120 * hours) < 5 * std::sqrt(120.0 * hours));
}

TEST_CASE("a full packet does not wait for the timer") {
    LineParameters parameters;
    parameters.latency_timer_ms = 16.0;
    Transport transport(parameters, 1, UtcTime(0s));
    transport.carry(61, UtcTime(1s));
    CHECK(transport.shown_at(61) > UtcTime(1s));
    const UtcTime full{1s + 100us};
    transport.carry(10, full);
    CHECK(transport.shown_at(62) == full);
    CHECK(transport.shown(full) == 62);
    CHECK(transport.shown_at(71) > full);
}

TEST_CASE("held bytes come in one burst, at the end of the longest hold") {
    Transport transport({}, 1, UtcTime(0s));
    transport.carry(kFrame, UtcTime(1s));
    transport.hold_until(UtcTime(3s));
    transport.carry(kFrame, UtcTime(2s));
    CHECK(transport.shown(UtcTime(3s) - 1ns) == 0);
    CHECK(transport.shown(UtcTime(3s)) == 2 * kFrame);
    transport.take(2 * kFrame);
    transport.carry(kFrame, UtcTime(4s));
    CHECK(transport.shown(UtcTime(4s)) == kFrame);
    transport.take(kFrame);
    transport.hold_until(UtcTime(8s));
    transport.hold_until(UtcTime(6s));
    transport.carry(1, UtcTime(5s));
    CHECK(transport.next_shown() == UtcTime(8s));
}

TEST_CASE("the delays depend only on the seed, and there are none without parameters") {
    LineParameters parameters;
    parameters.latency_timer_ms = 16.0;
    parameters.jitter_ms = 2.0;
    const auto one = delays_ms(carry(parameters, 100, 5));
    CHECK(one == delays_ms(carry(parameters, 100, 5)));
    CHECK(one != delays_ms(carry(parameters, 100, 6)));
    CHECK(delays_ms(carry({}, 100)) == std::vector<double>(100, 0.0));
}
