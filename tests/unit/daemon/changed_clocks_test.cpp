/// @file
/// Tests of a host that sleeps or inserts a leap second.  They are a separate program, because they
/// replace the system calls that read the clocks.

#include <sys/syscall.h>
#include <sys/timex.h>
#include <unistd.h>

#include <atomic>
#include <ctime>
#include "daemon/source/sensor_link.hpp"
#include "tests/support/catch.hpp"
#include "tests/unit/daemon/fake_sensor.hpp"

namespace {

std::atomic<int> slept_s{0};
std::atomic<int> calls_before_leap{-1};  ///< Clock calls until the leap second; negative: none.

/// Counts a clock call.  @return true once the leap second has been inserted
bool is_leap_over() {
    if (calls_before_leap <= 0) return calls_before_leap == 0;
    --calls_before_leap;
    return false;
}

}  // namespace

extern "C" int clock_gettime(clockid_t id, timespec* time) noexcept {
    const auto result = static_cast<int>(syscall(SYS_clock_gettime, id, time));
    if (id == CLOCK_BOOTTIME) time->tv_sec += slept_s;
    if (is_leap_over() && id == CLOCK_REALTIME) --time->tv_sec;
    return result;
}

extern "C" int adjtimex(timex* kernel) noexcept {
    *kernel = {};
    if (calls_before_leap < 0) return TIME_OK;
    return is_leap_over() ? TIME_OOP : TIME_INS;
}

using namespace a351;
using namespace a351::daemon::source;
using Kind = ReadQueue::Kind;

namespace {

struct Sleeper {
    FakeSensor sensor;
    ReadQueue queue;
    HostClock clock;
    SensorLink link{options(), clock, queue};

    Sleeper() { slept_s = 0; }

    [[nodiscard]] LinkOptions options() const {
        LinkOptions options;
        options.address.path = sensor.path();
        options.profile = wire::find_profile("A351");
        options.header.profile = "A351";
        return options;
    }

    void wait_for_frames() {
        const auto sent = sensor.frames_sent.load();
        REQUIRE(eventually([&] { return sensor.frames_sent >= sent + 20; }));
    }

    /// Empties the queue.  @return the kinds of its items in order; a run of one kind counts once
    std::vector<Kind> take_all() {
        std::vector<Kind> kinds;
        for (auto item = queue.front(); item; item = queue.front()) {
            if (kinds.empty() || kinds.back() != item->kind) kinds.push_back(item->kind);
            if (item->kind == Kind::session) static_cast<void>(queue.take_session());
            if (item->kind == Kind::woken) readings.push_back(queue.woken());
            if (item->kind == Kind::rx && !readings.empty())
                is_in_order &= item->time >= readings.back().raw;
            queue.pop();
        }
        return kinds;
    }
    std::vector<timing::ClockReading> readings;
    bool is_in_order = true;  ///< No bytes are older than the clock reading before them.
};

}  // namespace

TEST_CASE("each sleep of the host puts one clock reading before the bytes received after it") {
    Sleeper host;
    host.link.start();
    host.wait_for_frames();
    slept_s = 40;
    host.wait_for_frames();
    slept_s = 100;
    host.wait_for_frames();
    auto kinds = host.take_all();
    host.link.stop();
    kinds.resize(7);
    CHECK(kinds == std::vector{Kind::session, Kind::tx, Kind::rx, Kind::woken, Kind::rx,
                               Kind::woken, Kind::rx});
    REQUIRE(host.readings.size() == 2);
    const auto slept = [&](std::size_t i) {
        return host.readings[i].boottime - host.readings[i].raw.time_since_epoch();
    };
    CHECK(std::chrono::abs(slept(1) - slept(0) - std::chrono::seconds(60)) <
          Nanoseconds(std::chrono::milliseconds(10)));
    CHECK(host.is_in_order);
}

TEST_CASE("a sleep before the first byte of a session is reported after the session header") {
    Sleeper host;
    host.sensor.is_idle = true;
    host.link.start();
    REQUIRE(eventually([&] { return host.link.status().device.has_value(); }));
    slept_s = 40;
    // The reader checks for a sleep every 200 ms.
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    CHECK(host.queue.fill() == 0);
    host.sensor.is_idle = false;
    host.wait_for_frames();
    auto kinds = host.take_all();
    kinds.resize(4);
    CHECK(kinds == std::vector{Kind::session, Kind::tx, Kind::woken, Kind::rx});
    host.link.stop();
}

TEST_CASE(
    "a clock reading from before a leap second announces it, even if the leap interrupts it") {
    const HostClock clock;
    int before = 0, after = 0;
    for (int calls = 0; calls < 30; ++calls) {
        CAPTURE(calls);
        calls_before_leap = -1;
        const UtcTime start = host_realtime();
        calls_before_leap = calls;
        const timing::ClockReading reading = clock.read();
        const bool is_before = reading.realtime >= start;
        ++(is_before ? before : after);
        if (is_before) CHECK(reading.leap == timing::LeapSecond::inserted);
    }
    calls_before_leap = -1;
    CHECK(before > 0);
    CHECK(after > 0);
}
