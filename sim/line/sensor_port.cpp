#include "sim/line/sensor_port.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "protocol/core/input_error.hpp"

namespace a351::sim::line {
namespace {

using namespace std::chrono_literals;

/// Frames closer than this are sent together: more frequent waking would cost too much.
constexpr Nanoseconds kBatch = 1ms;
constexpr Nanoseconds kLongestWait = 100ms;
constexpr Nanoseconds kGrace = 2s;
/// Time in which nothing may be unread at the end: after a read the kernel refills a full terminal.
constexpr Nanoseconds kSettle = 200ms;
constexpr Nanoseconds kQuiet = 10ms;
/// Before the port is pulled out, the host may read, so that the bytes sent have arrived: until
/// nothing was unread for kQuietTurns turns of kBatch, at most for kMostTurns.  Turns are counted
/// because, when the machine pauses, time passes but neither the reader nor the kernel's worker
/// that empties the flip buffer runs.
constexpr int kQuietTurns = 20;
constexpr int kMostTurns = 1000;

}  // namespace

SensorPort::SensorPort(Pty& pty, device::LineDevice& device, Line& line, FaultInjector* faults,
                       TroubleHandler on_trouble)
    : pty_(pty),
      device_(device),
      line_(line),
      faults_(faults),
      sink_(faults != nullptr ? static_cast<device::LineSink&>(*faults) : line),
      on_trouble_(std::move(on_trouble)) {}

void SensorPort::serve(const device::Instant& now) {
    set_speeds();
    if (faults_ != nullptr) faults_->begin(now);
    is_waiting_for_baud_ = device_.waits_for_baud() && device_.baud() != host_baud_;
    if (!is_waiting_for_baud_)
        device_.advance_to({now.simulated + line_.lead(), now.steady}, sink_);
    if (faults_ != nullptr) faults_->catch_up(now);
    move_plug(now);
    take_commands(now);
    hand_over(now);
    watch_for_the_end(now);
}

void SensorPort::set_speeds() {
    host_baud_ = pty_.baud();
    line_.set_speeds(device_.baud(), host_baud_);
}

void SensorPort::take_commands(const device::Instant& now) {
    const auto commands = pty_.read();
    if (commands.empty() || plug_ != Plug::in) return;
    if (device_.baud() == host_baud_) {
        device_.receive(commands, now, sink_);
    } else if (host_baud_ > 0) {
        device_.receive(received_at_baud(commands, host_baud_, device_.baud()), now, sink_);
    }
    set_speeds();
}

void SensorPort::hand_over(const device::Instant& now) {
    const std::int64_t sent_before = line_.report().frames_sent;
    is_blocked_ = false;
    while (!is_blocked_ && !line_.shown(now.simulated).empty()) is_blocked_ = !hand_over_some(now);
    if (line_.report().frames_sent == sent_before) return;
    if (sent_before == 0) first_sent_ = now.steady;
    last_sent_ = now.steady;
}

/// Hands over some bytes.  @return false when the terminal is full.
bool SensorPort::hand_over_some(const device::Instant& now) {
    std::span<const std::byte> bytes = line_.shown(now.simulated);
    const bool loses = faults_ != nullptr && faults_->is_overrun(now.simulated);
    if (loses)
        bytes = bytes.first(std::min(bytes.size(), kReceiver - std::min(kReceiver, pty_.unread())));
    const std::size_t taken = bytes.empty() ? 0 : pty_.write(bytes);
    line_.handed_over(taken, now.simulated);
    if (loses) line_.overrun(line_.shown(now.simulated).size(), now.simulated);
    return taken > 0 || loses;
}

void SensorPort::move_plug(const device::Instant& now) {
    if (faults_ == nullptr) return;
    if (const auto asked = faults_->take_hang_up()) {
        if (plug_ == Plug::in) {
            plug_ = Plug::leaving;
            turns_ = quiet_turns_ = 0;
            hang_up_ = *asked;
        }
        hang_up_.until = std::max(hang_up_.until, asked->until);
        hang_up_.loses_power = hang_up_.loses_power || asked->loses_power;
    }
    if (plug_ == Plug::leaving) {
        quiet_turns_ = pty_.unread() == 0 ? quiet_turns_ + 1 : 0;
        if (quiet_turns_ == kQuietTurns || ++turns_ == kMostTurns) {
            bytes_unread_ += pty_.discard_unread();
            pty_.hang_up();
            plug_ = Plug::out;
        }
    }
    if (plug_ == Plug::out && now.simulated >= hang_up_.until) plug_in(now);
}

/// Plugs the port in.  If something else is at the path of the link, the port stays out, and the
/// next turn tries again.
void SensorPort::plug_in(const device::Instant& now) {
    try {
        pty_.come_back();
    } catch (const InputError& error) {
        if (trouble_ != error.what() && on_trouble_) on_trouble_(error.what());
        trouble_ = error.what();
        return;
    }
    trouble_.clear();
    faults_->end_hang_up(hang_up_, now);
    plug_ = Plug::in;
}

void SensorPort::watch_for_the_end(const device::Instant& now) {
    if (device_.next_due() || !line_.is_empty()) {
        ended_at_.reset();
        return;
    }
    if (!ended_at_) ended_at_ = now.steady;
    const Nanoseconds since = now.steady - *ended_at_;
    is_finished_ = (since > kSettle && pty_.unread() == 0) || since > kGrace;
}

void SensorPort::finish(UtcTime simulated) {
    was_drained_ = line_.is_empty();
    line_.abandon(simulated);
    Nanoseconds quiet{0};
    for (Nanoseconds waited{0}; waited < kSettle && quiet < kQuiet; waited += kBatch) {
        std::this_thread::sleep_for(kBatch);
        quiet = pty_.unread() == 0 ? quiet + kBatch : Nanoseconds(0);
    }
    const std::size_t unread = pty_.discard_unread();
    was_drained_ = was_drained_ && unread == 0;
    bytes_unread_ += unread;
}

void SensorPort::watch(std::vector<pollfd>& descriptors) const {
    descriptors.push_back(pty_.watched(is_blocked_));
}

Nanoseconds SensorPort::patience(const device::Instant& now, const ClockScale& clock) const {
    if (is_blocked_) return kLongestWait;
    const std::optional<UtcTime> due = device_.next_due();
    const std::optional<UtcTime> shown = line_.next_shown();
    if (plug_ != Plug::in || is_waiting_for_baud_ || (!due && !shown)) return kBatch;
    UtcTime next = UtcTime::max();
    if (due) next = std::min(next, *due - line_.lead());
    if (shown) next = std::min(next, *shown);
    const Nanoseconds wait = clock.host_at(next) - clock.host_at(now.simulated);
    // Frames closer than kBatch are sent together.
    const bool is_dense = now.steady - last_sent_ < kBatch;
    return std::clamp<Nanoseconds>(wait, is_dense ? kBatch : Nanoseconds(0), kLongestWait);
}

double SensorPort::real_seconds() const noexcept {
    return std::chrono::duration<double>(last_sent_ - first_sent_).count();
}

}  // namespace a351::sim::line
