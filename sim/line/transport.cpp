#include "sim/line/transport.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace a351::sim::line {
namespace {

/// Returns the first instant of a grid at or after `time`; `time` without a period.
UtcTime next_on_grid(UtcTime start, UtcTime time, double period_s, double phase) {
    if (period_s <= 0.0) return time;
    const double periods = seconds_between(start, time) / period_s - phase;
    const UtcTime tick = start + from_seconds((std::ceil(periods) + phase) * period_s);
    return std::max(tick, time);  // Rounding may leave it 1 ns short.
}

}  // namespace

Transport::Transport(const scenario::LineParameters& parameters, std::uint64_t seed, UtcTime start)
    : parameters_(parameters),
      start_(start),
      jitter_(seed, "line jitter"),
      stalls_(seed, "line stalls"),
      stall_start_(start),
      stall_end_(start),
      hold_until_(start),
      last_arrival_(start),
      last_shown_(start) {
    noise::RandomStream phases(seed, "line phases");
    timer_phase_ = phases.uniform();
    poll_phase_ = phases.uniform();
}

UtcTime Transport::after_stalls(UtcTime time) {
    if (parameters_.stall_per_h <= 0.0) return time;
    while (stall_end_ <= time) {
        const double wait_s = stalls_.exponential() * kSecondsPerHour / parameters_.stall_per_h;
        stall_start_ = stall_end_ + from_seconds(wait_s);
        stall_end_ = stall_start_ + from_seconds(stalls_.uniform(parameters_.stall_s.low,
                                                                 parameters_.stall_s.high));
    }
    return time >= stall_start_ ? stall_end_ : time;
}

void Transport::carry(std::size_t byte_count, UtcTime arrives) {
    arrives = last_arrival_ = std::max(arrives, last_arrival_);
    const double timer_s =
        1e-3 * parameters_.latency_timer_ms / (1.0 + 1e-6 * parameters_.latency_timer_ppm);
    while (byte_count > 0) {
        const bool is_open = !packets_.empty() && arrives <= packets_.back().closes &&
                             packets_.back().size < kPacketSize;
        if (!is_open) {
            if (!packets_.empty()) last_shown_ = packets_.back().shown;
            Packet packet;
            packet.closes = next_on_grid(start_, arrives, timer_s, timer_phase_);
            if (parameters_.jitter_ms > 0.0)
                packet.jitter = from_seconds(1e-3 * jitter_.uniform(0.0, parameters_.jitter_ms));
            packets_.push_back(packet);
        }
        Packet& packet = packets_.back();
        const std::size_t taken = std::min(byte_count, kPacketSize - packet.size);
        packet.size += taken;
        if (packet.size == kPacketSize) packet.closes = arrives;
        byte_count -= taken;
        if (is_open && packet.size < kPacketSize) continue;
        const UtcTime fetched =
            next_on_grid(start_, packet.closes, 1e-3 * parameters_.usb_poll_ms, poll_phase_) +
            packet.jitter;
        packet.shown = std::max({after_stalls(fetched), last_shown_, hold_until_});
    }
}

std::size_t Transport::shown(UtcTime now) const {
    std::size_t bytes = 0;
    for (const Packet& packet : packets_) {
        if (packet.shown > now) break;
        bytes += packet.size;
    }
    return bytes;
}

UtcTime Transport::shown_at(std::size_t byte_count) const {
    std::size_t bytes = 0;
    for (const Packet& packet : packets_) {
        bytes += packet.size;
        if (bytes >= byte_count) return packet.shown;
    }
    assert(false);
    return last_shown_;
}

void Transport::take(std::size_t byte_count) {
    while (byte_count > 0) {
        Packet& packet = packets_.front();
        const std::size_t taken = std::min(byte_count, packet.size);
        packet.size -= taken;
        byte_count -= taken;
        if (packet.size > 0) return;
        last_shown_ = std::max(last_shown_, packet.shown);
        packets_.pop_front();
    }
}

std::optional<UtcTime> Transport::next_shown() const {
    return packets_.empty() ? std::nullopt : std::optional(packets_.front().shown);
}

void Transport::hold_until(UtcTime end) {
    hold_until_ = std::max(hold_until_, end);
    for (Packet& packet : packets_) packet.shown = std::max(packet.shown, end);
}

}  // namespace a351::sim::line
