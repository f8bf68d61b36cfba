#include "sim/line/pty_device.hpp"

#include "sim/signal/signal_source.hpp"

#include <algorithm>
#include <chrono>

namespace a351::sim {
namespace {

using namespace std::chrono_literals;

/// Frames closer than this are sent together: waking more often costs more than it is worth.
constexpr Nanoseconds kBatch = 1ms;
constexpr Nanoseconds kLongestWait = 100ms;  ///< So that a signal is noticed.
constexpr Nanoseconds kGrace = 2s;
/// What was written passes the kernel's flip buffer before it counts as waiting to be read.
constexpr Nanoseconds kSettle = 200ms;

/// How long nothing needs doing.
Nanoseconds idle_time(const DeviceStream& stream, const ClockScale& clock) {
    const std::optional<UtcTime> due = stream.next_due();
    if (!due) return kBatch;
    const Nanoseconds wait = clock.host_at(*due) - host_now();
    const Nanoseconds interval = from_seconds(1.0 / (SignalSource::kRateHz * clock.factor));
    return std::clamp<Nanoseconds>(wait, interval < kBatch ? kBatch : Nanoseconds(0), kLongestWait);
}

}  // namespace

PtyRun serve(Pty& pty, DeviceStream& stream, const ClockScale& clock,
             const std::function<bool()>& should_stop) {
    PtyRun run;
    Nanoseconds first_sent{0};
    Nanoseconds finished_at{0};
    while (!should_stop()) {
        stream.advance_to(clock.simulated(host_now()));
        stream.receive(pty.read(), steady_now());
        if (!stream.pending().empty()) {
            const std::int64_t sent_before = stream.report().frames_sent;
            stream.handed_over(pty.write(stream.pending()), clock.simulated(host_now()));
            if (stream.report().frames_sent > sent_before) {
                if (sent_before == 0) first_sent = steady_now();
                run.real_seconds = std::chrono::duration<double>(steady_now() - first_sent).count();
            }
        }
        if (stream.is_finished()) {
            if (finished_at == Nanoseconds(0)) finished_at = steady_now();
            const Nanoseconds since = steady_now() - finished_at;
            run.was_drained = since > kSettle && pty.is_drained();
            if (run.was_drained || since > kGrace) break;
        }
        const bool is_full = !stream.pending().empty();
        pty.wait(is_full, is_full ? kLongestWait : idle_time(stream, clock));
    }
    return run;
}

}  // namespace a351::sim
