#include "protocol/timing/sample_index.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::timing;
using namespace std::chrono_literals;
using Kind = Placement::Kind;

namespace {

/// A device at `rate_hz` whose frames arrive without delay, driven by its true sample number.
class Device {
public:
    explicit Device(int rate_hz, std::uint16_t first_count = 0)
        : rate_hz_(rate_hz),
          step_(static_cast<std::uint16_t>(4000 / rate_hz)),
          first_count_(first_count),
          index_(step_, Hertz(rate_hz)) {}

    Placement frame(std::int64_t k, bool contiguous = true, Nanoseconds late = 0s) {
        return index_.place(count(k), contiguous, time(k) + late);
    }
    Placement raw(std::uint16_t count, bool contiguous, RawTime arrival) {
        return index_.place(count, contiguous, arrival);
    }
    [[nodiscard]] std::uint16_t count(std::int64_t k) const {
        return static_cast<std::uint16_t>(first_count_ + step_ * (k + 1));
    }
    [[nodiscard]] RawTime time(std::int64_t k) const {
        return RawTime(100s) + k * (Nanoseconds(1s) / rate_hz_);
    }

private:
    int rate_hz_;
    std::uint16_t step_;
    std::uint16_t first_count_;
    SampleIndex index_;
};

bool is_gap_up_to(std::int64_t index, const Placement& found) {
    return found.kind == Kind::after_gap && found.index == index;
}

}  // namespace

TEST_CASE("the index counts frames through every wrap of the counter") {
    for (const int rate_hz : {50, 100, 200, 500, 1000}) {
        Device device(rate_hz, 0x7F04);
        CHECK(device.frame(0).kind == Kind::first);
        bool all_next = true;
        for (std::int64_t k = 1; k < 70'000; ++k) {
            const auto placement = device.frame(k);
            all_next = all_next && placement.kind == Kind::next && placement.index == k;
        }
        CHECK(all_next);
    }
}

TEST_CASE(
    "a gap within contiguous bytes is exact from the counter alone, however late the bytes "
    "arrive") {
    for (std::int64_t missing = 1; missing <= 818; ++missing) {
        Device device(50);
        (void)device.frame(0);
        const auto placement = device.frame(missing + 1, true, missing % 3 * 7s);
        INFO(missing);
        if (missing <= 767) {  // larger gaps look like a step back by up to 4096 ticks
            CHECK(is_gap_up_to(missing + 1, placement));
            CHECK(placement.missing == missing);
        }
    }
}

TEST_CASE("a gap is exact after outages of many wraps") {
    for (const auto outage : {17s, 40s, 81s, 82s, 90s, 1000s, 36'000s}) {
        for (const int rate_hz : {50, 100, 200, 500, 1000}) {
            const Nanoseconds drift = Nanoseconds(outage) / 100'000;  // an oscillator 10 ppm off
            for (const Nanoseconds late :
                 {Nanoseconds(0), Nanoseconds(16ms), Nanoseconds(800ms), drift, -drift}) {
                Device device(rate_hz);
                for (std::int64_t k = 0; k < 100; ++k) (void)device.frame(k);
                const std::int64_t k = 103 + outage.count() * rate_hz;
                const auto placement = device.frame(k, false, late);
                INFO(outage.count() << " s at " << rate_hz << " Hz");
                CHECK(is_gap_up_to(k, placement));
                CHECK(placement.missing == k - 100);
            }
        }
    }
    Device device(50);  // Also if the caller calls the bytes contiguous.
    (void)device.frame(0);
    CHECK(is_gap_up_to(851, device.frame(851)));  // 17 s, no multiple of 80 in the counter
}

TEST_CASE("a backlog after a pause of the host loses nothing and its end shows the true gap") {
    // The kernel kept the first 3.4 s and dropped the rest; all is read at once.
    for (std::int64_t pause_s = 4; pause_s <= 200; ++pause_s) {
        Device device(50);
        for (std::int64_t k = 0; k < 100; ++k) (void)device.frame(k);
        const std::int64_t last = 100 + 50 * pause_s;
        const RawTime woken = device.time(last);
        bool is_whole = device.raw(device.count(100), pause_s < 10, woken).kind == Kind::next;
        for (std::int64_t k = 101; k < 270; ++k)
            is_whole &= device.raw(device.count(k), true, woken).kind == Kind::next;
        CHECK(is_whole);
        CAPTURE(pause_s);
        CHECK(is_gap_up_to(last, device.raw(device.count(last), true, woken)));
    }
}

TEST_CASE("frames that are only late are placed by their counter") {
    // At 1000x a host's pause of 100 ms is 100 s of instrument time.
    Device device(50);
    (void)device.frame(0);
    CHECK(device.frame(1, false, 100s).kind == Kind::next);
    CHECK(is_gap_up_to(4, device.frame(4, false, 200s)));
}

TEST_CASE("a counter that disagrees with the elapsed time begins a new session") {
    int missed = 0;
    for (std::int64_t before = 100; before < 4196; ++before) {
        Device device(50);
        (void)device.frame(before);
        const RawTime arrival = device.time(before) + 30s;
        if (device.raw(80, false, arrival).kind != Kind::new_session) ++missed;
    }
    // A difference within 1 s of 81.92 s fits by chance: one in 41 (99 to 101 of 4096). Another 51
    // count as late bytes with up to 1 s missing.
    CHECK(missed <= 152);
    CHECK(missed >= 99);
}

TEST_CASE(
    "a repeated counter, or one that jumps back or by no multiple of the step, does not change the "
    "index") {
    for (const int rate_hz : {50, 100, 200, 500, 1000}) {
        for (const int jump : {0, 1, 3, 16, 79, 81, -4, -80, -160, -1000}) {
            Device device(rate_hz);
            const int step = 4000 / rate_hz;
            if (jump > 0 && jump % step == 0) continue;
            for (std::int64_t k = 0; k < 10; ++k) (void)device.frame(k);
            const auto wrong = static_cast<std::uint16_t>(device.count(9) + jump);
            INFO(jump << " at " << rate_hz << " Hz");
            CHECK(device.raw(wrong, true, device.time(10)).kind ==
                  (jump == 0 ? Kind::duplicate : Kind::anomaly));
            CHECK(is_gap_up_to(11, device.frame(11)));
        }
    }
}

TEST_CASE("a counter that restarts in mid-stream begins a new session with its second frame") {
    Device device(50);
    for (std::int64_t k = 0; k < 10; ++k) (void)device.frame(k);
    CHECK(device.raw(7, true, device.time(10)).kind == Kind::anomaly);
    CHECK(device.raw(87, true, device.time(11)).kind == Kind::new_session);
}
