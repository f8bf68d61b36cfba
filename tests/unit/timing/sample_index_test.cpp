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

}  // namespace

TEST_CASE("the index counts frames through every wrap of the counter", "[timing][sample_index]") {
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
    "a gap within contiguous bytes is exact from the counter alone, however late the bytes arrive",
    "[timing][sample_index]") {
    for (std::int64_t missing = 1; missing <= 818; ++missing) {
        Device device(50);
        (void)device.frame(0);
        const auto placement = device.frame(missing + 1, true, missing % 3 * 7s);
        INFO(missing);
        if (missing <= 767) {  // larger gaps look like a step back by up to 4096 ticks
            CHECK(placement.kind == Kind::after_gap);
            CHECK(placement.missing == missing);
            CHECK(placement.index == missing + 1);
        }
    }
}

TEST_CASE("a gap is exact after outages of many wraps", "[timing][sample_index]") {
    for (const auto outage : {17s, 40s, 81s, 82s, 90s, 1000s, 36'000s}) {
        for (const int rate_hz : {50, 100, 200, 500, 1000}) {
            for (const Nanoseconds late : {Nanoseconds(0), Nanoseconds(16ms), Nanoseconds(800ms)}) {
                Device device(rate_hz);
                for (std::int64_t k = 0; k < 100; ++k) (void)device.frame(k);
                const std::int64_t k = 103 + outage.count() * rate_hz;
                const auto placement = device.frame(k, false, late);
                INFO(outage.count() << " s at " << rate_hz << " Hz");
                CHECK(placement.kind == Kind::after_gap);
                CHECK(placement.index == k);
                CHECK(placement.missing == k - 100);
            }
        }
    }
}

TEST_CASE(
    "an outage longer than a counter wrap is exact even if the caller calls the bytes contiguous",
    "[timing][sample_index]") {
    Device device(50);
    (void)device.frame(0);
    const auto placement = device.frame(851);  // 17 s: the counter difference is no multiple of 80
    CHECK(placement.kind == Kind::after_gap);
    CHECK(placement.index == 851);
}

TEST_CASE("a gap of ten hours is exact with an oscillator 10 ppm off", "[timing][sample_index]") {
    for (const int ppm : {-10, 10}) {
        Device device(50);
        for (std::int64_t k = 0; k < 3000; ++k) (void)device.frame(k);
        const std::int64_t k = 1'800'000;
        const auto placement = device.frame(k, false, Nanoseconds(36'000s) / 1'000'000 * ppm);
        CHECK(placement.index == k);
    }
}

TEST_CASE("a backlog after a pause of the host loses nothing and its end shows the true gap",
          "[timing][sample_index]") {
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
        const auto placement = device.raw(device.count(last), true, woken);
        CAPTURE(pause_s);
        CHECK(placement.kind == Kind::after_gap);
        CHECK(placement.index == last);
    }
}

TEST_CASE("frames that are only late are placed by their counter", "[timing][sample_index]") {
    // At 1000x a host's pause of 100 ms is 100 s of instrument time.
    Device device(50);
    (void)device.frame(0);
    CHECK(device.frame(1, false, 100s).kind == Kind::next);
    const auto placement = device.frame(4, false, 200s);
    CHECK(placement.kind == Kind::after_gap);
    CHECK(placement.missing == 2);
}

TEST_CASE("a counter that disagrees with the elapsed time begins a new session",
          "[timing][sample_index]") {
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

TEST_CASE("a repeated counter is a duplicate and does not change the index",
          "[timing][sample_index]") {
    Device device(50);
    (void)device.frame(0);
    CHECK(device.frame(0).kind == Kind::duplicate);
    const auto placement = device.frame(1);
    CHECK(placement.kind == Kind::next);
    CHECK(placement.index == 1);
}

TEST_CASE(
    "a counter that jumps back, or by no multiple of the step, is an anomaly that does not change "
    "the index",
    "[timing][sample_index]") {
    for (const int rate_hz : {50, 100, 200, 500, 1000}) {
        for (const int jump : {1, 3, 16, 79, 81, -4, -80, -160, -1000}) {
            Device device(rate_hz);
            const int step = 4000 / rate_hz;
            if (jump > 0 && jump % step == 0) continue;
            for (std::int64_t k = 0; k < 10; ++k) (void)device.frame(k);
            const auto wrong = static_cast<std::uint16_t>(device.count(9) + jump);
            INFO(jump << " at " << rate_hz << " Hz");
            CHECK(device.raw(wrong, true, device.time(10)).kind == Kind::anomaly);
            const auto placement = device.frame(11);
            CHECK(placement.kind == Kind::after_gap);
            CHECK(placement.index == 11);
        }
    }
}

TEST_CASE("a counter that restarts in mid-stream begins a new session with its second frame",
          "[timing][sample_index]") {
    Device device(50);
    for (std::int64_t k = 0; k < 10; ++k) (void)device.frame(k);
    CHECK(device.raw(7, true, device.time(10)).kind == Kind::anomaly);
    CHECK(device.raw(87, true, device.time(11)).kind == Kind::new_session);
}
