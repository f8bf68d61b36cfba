#pragma once

#include <functional>
#include <string>

#include "sim/line/fault_injector.hpp"
#include "sim/line/line.hpp"
#include "sim/line/pty.hpp"
#include "sim/line/service.hpp"

namespace a351::sim {

/// The sensor's port: joins a device, its line and the pseudo-terminal.  Frames keep an absolute
/// grid: when the terminal is full they wait, and are sent late but never lost, unless the fault
/// `overrun` makes the terminal a receiver of kReceiver bytes.  Where the speed of the host's
/// terminal is not the device's, bytes of both directions arrive garbled.
///
/// The device's own times (start-up, tests) are real time, as are the host's time-outs.
class SensorPort final : public Service {
public:
    /// What a Linux terminal keeps for a reader that does not come (N_TTY_BUF_SIZE less one).
    static constexpr std::size_t kReceiver = 4095;

    /// Told what keeps the port from being plugged in again, once per trouble.
    using TroubleHandler = std::function<void(const std::string&)>;

    /// All must outlive this.  @param faults  null: none, and the device sends to the line itself.
    SensorPort(Pty& pty, LineDevice& device, Line& line, FaultInjector* faults = nullptr,
               TroubleHandler on_trouble = {});

    void serve(const Instant& now) override;
    void watch(std::vector<pollfd>& descriptors) const override;
    [[nodiscard]] Nanoseconds patience(const Instant& now, const ClockScale& clock) const override;

    /// The device has no more to send, and the host has read it all or 2 s more have passed.
    [[nodiscard]] bool is_finished() const noexcept { return is_finished_; }

    /// The end: gives the host 200 ms for what it has not read, then settles what is left.
    void finish(UtcTime simulated);

    /// At the end nothing was under way and the host had read everything.
    [[nodiscard]] bool was_drained() const noexcept { return was_drained_; }

    /// Real time from the first frame handed over to the last.
    [[nodiscard]] double real_seconds() const noexcept;

    /// Bytes handed over that the host had not read when the port was pulled out, or at the end.
    [[nodiscard]] std::size_t bytes_unread() const noexcept { return bytes_unread_; }

private:
    enum class Plug { in, leaving, out };

    [[nodiscard]] LineSink& sink() noexcept;
    void set_speeds();
    void take_commands(const Instant& now);
    void hand_over(const Instant& now);
    [[nodiscard]] bool hand_over_some(const Instant& now);
    void move_plug(const Instant& now);
    void plug_in(const Instant& now);
    void watch_for_the_end(const Instant& now);

    Pty& pty_;
    LineDevice& device_;
    Line& line_;
    FaultInjector* faults_;
    TroubleHandler on_trouble_;
    int host_baud_ = 0;
    bool is_blocked_ = false;  ///< The terminal takes no more.
    Plug plug_ = Plug::in;
    FaultInjector::HangUp hang_up_;
    int turns_ = 0, quiet_turns_ = 0;  ///< Since it is leaving; and with nothing unread.
    std::string trouble_;  ///< That keeps it out.
    std::size_t bytes_unread_ = 0;
    Nanoseconds first_sent_{0}, last_sent_{0};
    std::optional<Nanoseconds> ended_at_;
    bool is_finished_ = false;
    bool was_drained_ = false;
};

}  // namespace a351::sim
