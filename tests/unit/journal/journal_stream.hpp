#pragma once
/// @file
/// A device and a host for tests: true samples -> frames -> journal chunks.

#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "protocol/archive/archiver.hpp"
#include "protocol/wire/burst_frame.hpp"

namespace a351::journal {

inline const UtcTime kStart = *parse_rfc3339("2026-03-01T12:00:00Z");
inline constexpr RawTime kRawStart{std::chrono::hours(1)};

inline timing::ClockReading clock_at(Nanoseconds since_start) {
    return {kRawStart + since_start, Nanoseconds(0), kStart + since_start, true, 500, 100};
}

inline Header header_at(Nanoseconds since_start, std::uint8_t session = 1) {
    Header header;
    header.session.bytes[0] = session;
    header.boot_id = "00000000-0000-4000-8000-000000000001";
    header.program_version = "test";
    header.profile = "A352AD10";
    header.product_id = "A352AD10";
    header.serial_number = "T0000001";
    header.output_rate_hz = 50;
    header.filter = "k512_fc9";
    header.burst_ctrl = wire::BurstLayout::recommended().burst_ctrl();
    header.baud = 460'800;
    header.clock = clock_at(since_start);
    return header;
}

/// Returns the values of sample k: noise with the spread of a quiet site, the same on every call.
inline wire::BurstValues values_of(std::int64_t k) {
    std::minstd_rand random(static_cast<unsigned>(k + 1));
    const auto noise = [&] { return static_cast<std::int32_t>(random() % 41) - 20; };
    wire::BurstValues values;
    values.flag = 0x8E00;
    values.temperature = -2'000'000 + static_cast<std::int32_t>(k / 100);
    values.axes = {noise(), 1000 + noise(), 16'777'216 + noise()};
    values.count = static_cast<std::uint16_t>(80 * (k + 1));
    return values;
}

inline std::vector<std::byte> frame_of(const wire::BurstValues& values) {
    std::vector<std::byte> bytes;
    wire::append_frame(wire::BurstLayout::recommended(), values, bytes);
    return bytes;
}

/// Returns the time since kStart at which the last byte of sample k's frame has arrived.
inline Nanoseconds due(std::int64_t k) { return std::chrono::milliseconds(20 * (k + 1)); }

/// Collector of chunks; frames are kept in a pending RX chunk until flush().
class JournalStream {
public:
    explicit JournalStream(std::uint8_t session = 1, Nanoseconds since_start = Nanoseconds(0)) {
        chunks.emplace_back(header_at(since_start, session));
    }

    void frame(std::int64_t k) { bytes(frame_of(values_of(k)), due(k)); }

    /// Adds frames in chunks of one second, each followed by a clock reading.
    /// @param later   time by which all come later
    /// @param change  changes the values of a frame before it is sent
    void frames(std::int64_t first, std::int64_t end, Nanoseconds later = Nanoseconds(0),
                const std::function<void(std::int64_t, wire::BurstValues&)>& change = {}) {
        for (std::int64_t k = first; k < end; ++k) {
            auto values = values_of(k);
            if (change) change(k, values);
            bytes(frame_of(values), later + due(k));
            if (k % 50 == 49) second(later + due(k));
        }
        flush();
    }
    void bytes(const std::vector<std::byte>& more, Nanoseconds arrival) {
        pending_.bytes.insert(pending_.bytes.end(), more.begin(), more.end());
        pending_.reads.push_back(
            {static_cast<std::uint32_t>(pending_.bytes.size()), kRawStart + arrival});
    }
    void second(Nanoseconds since_start) {
        flush();
        chunks.emplace_back(clock_at(since_start));
    }
    /// Adds an answer of the controller: process value in 0.1 degC, set point 42.5 degC, heating
    /// 61.7 %.
    void oven(Nanoseconds since_start, std::uint16_t process_value, std::uint16_t status = 0x0100) {
        flush();
        chunks.emplace_back(OvenChunk{kRawStart + since_start,
                                      OvenOutcome::answered,
                                      1,
                                      {process_value, status, 425, 0, 617}});
    }
    void flush() {
        if (!pending_.bytes.empty()) chunks.emplace_back(std::exchange(pending_, {}));
    }

    std::vector<Chunk> chunks;

private:
    RxChunk pending_;
};

}  // namespace a351::journal
