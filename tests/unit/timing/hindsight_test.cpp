#include "protocol/timing/hindsight.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::timing;
using namespace std::chrono_literals;

namespace {

const UtcTime kNoon = *parse_rfc3339("2026-03-01T12:00:00Z");

/// A host in true time, with a clock reading each second while it is awake.
struct Host {
    UtcHistory history;
    Nanoseconds now{0}, slept{0};
    bool is_synchronised = true;
    Nanoseconds clock_off{0};

    [[nodiscard]] RawTime raw() const { return RawTime(500s + now - slept); }
    void run(int seconds) {
        for (int i = 0; i < seconds; ++i) {
            now += 1s;
            history.observe({raw(), raw().time_since_epoch() + slept, kNoon + now + clock_off,
                             is_synchronised, 1000, 0});
        }
    }
    void sleep(Nanoseconds length) {
        now += length;
        slept += length;
    }
    /// Returns the error of the history at a time of this host, given by its raw and its true time.
    [[nodiscard]] Nanoseconds error(RawTime at, Nanoseconds truth, std::size_t sleeps = 0) const {
        return history.at(at, sleeps).utc - (kNoon + truth);
    }
};

}  // namespace

TEST_CASE("in hindsight a sleep is bridged, whether or not the host is synchronised after it") {
    for (const bool is_synchronised_later : {true, false}) {
        Host host;
        host.run(100);
        host.sleep(1h);
        host.is_synchronised = false;
        host.run(30);
        const RawTime woken = host.raw();
        const Nanoseconds truth = host.now;
        host.run(30);
        host.is_synchronised = is_synchronised_later;
        host.run(100);
        CHECK(std::chrono::abs(host.error(woken, truth, 1)) < Nanoseconds(1ms));
        CHECK((host.history.at(woken, 1).error < Nanoseconds(10ms)) == is_synchronised_later);
        CHECK(std::chrono::abs(host.error(RawTime(550s), 50s)) < Nanoseconds(1ms));
    }
}

TEST_CASE(
    "in hindsight times before a sleep are right to 1 s if the host is synchronised only after "
    "it") {
    Host host;
    host.is_synchronised = false;
    host.clock_off = -5h;
    host.run(100);
    host.sleep(1h);
    host.run(10);
    host.is_synchronised = true;
    host.clock_off = 0h;
    host.run(100);
    CHECK(std::chrono::abs(host.error(RawTime(550s), 50s)) < Nanoseconds(1ms));
    CHECK(host.history.at(RawTime(550s), 0).error >= Nanoseconds(1s));
}

TEST_CASE("in hindsight a clock that was set and set back counts as never set") {
    Host host;
    host.run(100);
    host.clock_off = 5s;
    host.run(40);
    const RawTime wrong = host.raw();
    const Nanoseconds truth = host.now;
    host.clock_off = 0s;
    host.run(100);
    CHECK(std::chrono::abs(host.error(wrong, truth)) < Nanoseconds(1ms));
    CHECK(host.history.at(wrong, 0).stretch == host.history.at(host.raw(), 0).stretch);
}

TEST_CASE("in hindsight a lasting step of the clock is placed at the reading that shows it") {
    Host host;
    host.run(100);
    const RawTime before = host.raw();
    host.clock_off = 5s;
    host.run(100);
    CHECK(host.history.at(before, 0).stretch + 1 == host.history.at(host.raw(), 0).stretch);
    CHECK(std::chrono::abs(host.error(before + 500ms, 100s + 500ms)) < Nanoseconds(1ms));
    CHECK(std::chrono::abs(host.error(host.raw(), host.now) - 5s) < Nanoseconds(1ms));
}

TEST_CASE("in hindsight a gap of 60 years adds no pieces") {
    Host host;
    host.run(100);
    Hindsight hindsight({Hertz(50.0), 0s}, 0);
    constexpr std::int64_t kAfter = 60 * 366LL * 24 * 3600 * 50;
    for (const std::int64_t begin : {std::int64_t{0}, kAfter})
        for (std::int64_t k = begin; k < begin + 5000; ++k)
            hindsight.observe(k, RawTime(500s + k * 20ms));
    const auto pieces = hindsight.times(host.history);
    CHECK(pieces.size() == 200);
    CHECK(pieces[100].first == kAfter);
    CHECK(pieces[100].time - kNoon == kAfter * Nanoseconds(20ms));
}
