#pragma once
/// @file
/// What a sensor that agrees with its profile would have answered and sent, to be changed by a test.

#include <cstdint>
#include <functional>
#include <random>
#include <string>

#include "daemon/identify/report.hpp"
#include "protocol/wire/burst_frame.hpp"
#include "protocol/wire/registers.hpp"

namespace a351::daemon::identify {

struct MadeUpSensor {
    std::string product = "A351AU10";
    double rate_hz = 50.0;
    int count_step = 80;
    /// Changes the i-th frame before it is sent.
    std::function<void(int i, wire::BurstValues&)> change = [](int, wire::BurstValues&) {};

    /// Returns what is seen in 50 s of an oven at 42.5 degC: one count is 3.8 mdegC, or 20 ug.
    [[nodiscard]] Observation observe() const {
        Observation seen;
        seen.port = "/dev/ttyUSB0";
        seen.baud = 460800;
        seen.has_answered = true;
        seen.start_up_test = wire::StartUpTest::passed;
        seen.device = {product, "00000042", 7, 0, true};
        seen.time = *parse_rfc3339("2026-03-01T12:00:00Z");
        for (const wire::Register& reg : wire::kRegisters)
            seen.registers.push_back({&reg, reg.default_value});
        std::minstd_rand random(1);
        const auto noise = [&](int size) {
            return static_cast<std::int32_t>(random() % (2 * static_cast<unsigned>(size) + 1)) -
                   size;
        };
        constexpr int kFrames = 2500;
        for (int i = 0; i < kFrames; ++i) {
            wire::BurstValues values;
            values.flag = 0x8E00;
            values.temperature = -1981 + noise(2);
            values.axes = {noise(300), 100'000 + noise(300), (1 << 24) + noise(300)};
            values.count = static_cast<std::uint16_t>(count_step * (i + 1));
            change(i, values);
            wire::append_frame(wire::BurstLayout::recommended(), values, seen.bytes);
            seen.reads.push_back({static_cast<std::uint32_t>(seen.bytes.size()),
                                  RawTime(from_seconds(i / rate_hz))});
        }
        return seen;
    }
};

inline Expected expected_a351() {
    Expected expected;
    expected.profile = wire::find_profile("A351");
    expected.axes = {"1", "2", "Z"};
    return expected;
}

}  // namespace a351::daemon::identify
