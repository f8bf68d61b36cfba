#pragma once
/// @file
/// Delays between the device's output and the host's input: the adapter's latency timer, USB
/// polling, scheduling and stalls.  Simulated time, no clock; random numbers depend on a seed only.

#include <cstdint>
#include <deque>
#include <optional>

#include "protocol/core/utc_time.hpp"
#include "sim/noise/random.hpp"
#include "sim/scenario/scenario.hpp"

namespace a351::sim::line {

/// Bytes travel in packets that never overtake each other.  A packet is closed at the next tick of
/// the adapter's latency timer or when it holds kPacketSize bytes.  The host fetches it at its next
/// poll.  Then it is delayed by the jitter and, if it falls into a stall, to the end of the stall:
///
///     shown = max(shown of the packet before, stall(poll(min(tick, full)) + jitter))
///
/// The phases of both grids are drawn from the seed.  Without any delay, bytes are shown when they
/// arrive.
class Transport {
public:
    /// Payload of a full-speed USB packet: 64 bytes minus two status bytes (FTDI, AN232B-04, Data
    /// Throughput, Latency and Handshaking).
    static constexpr std::size_t kPacketSize = 62;

    /// @param start  origin of the grids; no byte arrives before it.
    Transport(const scenario::LineParameters& parameters, std::uint64_t seed, UtcTime start);

    /// Takes bytes that arrive at the adapter together, after those of earlier calls.
    void carry(std::size_t byte_count, UtcTime arrives);

    /// Returns how many of the bytes carried and not yet taken the host may see.
    [[nodiscard]] std::size_t shown(UtcTime now) const;

    /// Removes the first `byte_count` bytes.
    void take(std::size_t byte_count);

    /// Returns when the next bytes are shown; std::nullopt if none are under way.
    [[nodiscard]] std::optional<UtcTime> next_shown() const;

    /// Shows nothing before `end`: the host pauses.
    void hold_until(UtcTime end);

    /// Returns when the last of the first `byte_count` bytes not yet taken is shown.
    [[nodiscard]] UtcTime shown_at(std::size_t byte_count) const;

private:
    struct Packet {
        std::size_t size = 0;
        UtcTime closes;  ///< End of its time to take bytes.
        UtcTime shown;
        Nanoseconds jitter{0};
    };
    [[nodiscard]] UtcTime after_stalls(UtcTime time);

    scenario::LineParameters parameters_;
    UtcTime start_;
    noise::RandomStream jitter_, stalls_;
    double timer_phase_, poll_phase_;  ///< Phases in periods, 0 to 1.
    UtcTime stall_start_, stall_end_;  ///< Limits of the present or next stall.
    UtcTime hold_until_;
    UtcTime last_arrival_;
    UtcTime last_shown_;  ///< Time of the packet before the newest.
    std::deque<Packet> packets_;
};

}  // namespace a351::sim::line
