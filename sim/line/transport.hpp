#pragma once
/// @file
/// Delays between the device's output and the host's input: the adapter's latency timer, USB
/// polling, scheduling and stalls.  Simulated time, no clock; random numbers of a seed only.

#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "sim/noise/random.hpp"
#include "sim/scenario/scenario.hpp"

namespace a351::sim {

/// Bytes travel in packets that never overtake each other.  One is closed by the next tick of the
/// adapter's latency timer or when it holds kPacketSize bytes, fetched at the host's next poll,
/// delayed by the jitter, and held until the end of a stall that it falls into:
///
///     shown = max(shown of the packet before, stall(poll(min(tick, full)) + jitter))
///
/// Phases of both grids are drawn from the seed.  Without any of this, bytes are shown when they
/// arrive.
class Transport {
public:
    /// Payload of a full-speed USB packet of 64 bytes behind two status bytes (FTDI, AN232B-04,
    /// Data Throughput, Latency and Handshaking).
    static constexpr std::size_t kPacketSize = 62;

    /// @param start  zero of the grids; no byte arrives before it.
    Transport(const LineParameters& parameters, std::uint64_t seed, UtcTime start);

    /// Takes bytes that arrive at the adapter together, behind those before.
    void carry(std::size_t byte_count, UtcTime arrives);

    /// How many bytes the host may see of those carried and not yet taken.
    [[nodiscard]] std::size_t shown(UtcTime now) const;

    /// The first `byte_count` bytes are gone.
    void take(std::size_t byte_count);

    /// When the next bytes are shown; std::nullopt when none are on their way.
    [[nodiscard]] std::optional<UtcTime> next_shown() const;

    /// Nothing that arrives or waits is shown before this: the host pauses.
    void hold_until(UtcTime end);

    /// When the byte that ends the first `byte_count` ones not yet taken is shown.
    [[nodiscard]] UtcTime shown_at(std::size_t byte_count) const;

private:
    struct Packet {
        std::size_t size = 0;
        UtcTime closes;  ///< Takes bytes until then.
        UtcTime shown;
        Nanoseconds jitter{0};
    };
    [[nodiscard]] UtcTime next_tick(UtcTime time) const;
    [[nodiscard]] UtcTime next_poll(UtcTime time) const;
    [[nodiscard]] UtcTime after_stalls(UtcTime time);
    void schedule(Packet& packet);

    LineParameters parameters_;
    UtcTime start_;
    RandomStream jitter_, stalls_;
    double timer_phase_, poll_phase_;  ///< In periods, 0 to 1.
    UtcTime stall_start_, stall_end_;  ///< Of the next stall.
    UtcTime hold_until_;
    UtcTime last_arrival_;
    UtcTime last_shown_;  ///< Of the packet before the newest.
    std::vector<Packet> packets_;
    std::size_t front_ = 0;  ///< Packets before it are gone.
};

}  // namespace a351::sim
