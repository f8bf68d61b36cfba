#pragma once

#include <functional>
#include <string>

#include "sim/line/fault_injector.hpp"
#include "sim/line/line.hpp"
#include "sim/line/pty.hpp"
#include "sim/line/service.hpp"

namespace a351::sim::line {

/// The sensor's port: connects a device, its line and the pseudo-terminal.  Frames keep an absolute
/// grid.  When the terminal is full they wait, and are sent late but not lost; with the fault
/// `overrun` the terminal keeps kReceiver bytes and further bytes are lost.  If the baud rates of
/// the device and of the host's terminal differ, bytes in both directions arrive garbled.
///
/// The device's own times (start-up, tests) are in real time, like the host's time-outs.
class SensorPort final : public Service {
public:
    /// Bytes that a Linux terminal keeps for a reader that does not read: N_TTY_BUF_SIZE - 1.
    static constexpr std::size_t kReceiver = 4095;

    /// Called once per reason that keeps the port from being plugged in again.
    using TroubleHandler = std::function<void(const std::string&)>;

    /// All arguments must outlive this.
    /// @param faults  null: no faults, and the device sends directly to the line.
    SensorPort(Pty& pty, device::LineDevice& device, Line& line, FaultInjector* faults = nullptr,
               TroubleHandler on_trouble = {});

    void serve(const device::Instant& now) override;
    void watch(std::vector<pollfd>& descriptors) const override;
    [[nodiscard]] Nanoseconds patience(const device::Instant& now,
                                       const ClockScale& clock) const override;

    /// Returns true when the device has nothing more to send, and the host has read everything.
    /// If the host reads nothing, returns true 2 s after the device's last byte.
    [[nodiscard]] bool is_finished() const noexcept { return is_finished_; }

    /// Ends the port: gives the host up to 200 ms to read, then settles the rest.
    void finish(UtcTime simulated);

    /// Returns true if at the end nothing was under way and the host had read everything.
    [[nodiscard]] bool was_drained() const noexcept { return was_drained_; }

    /// Returns the real time from the first frame handed over to the last.
    [[nodiscard]] double real_seconds() const noexcept;

    /// Returns the number of bytes that the host had not read at hang-ups and at the end.
    [[nodiscard]] std::size_t bytes_unread() const noexcept { return bytes_unread_; }

private:
    enum class Plug { in, leaving, out };

    void set_speeds();
    void take_commands(const device::Instant& now);
    void hand_over(const device::Instant& now);
    [[nodiscard]] bool hand_over_some(const device::Instant& now);
    void move_plug(const device::Instant& now);
    void plug_in(const device::Instant& now);
    void watch_for_the_end(const device::Instant& now);

    Pty& pty_;
    device::LineDevice& device_;
    Line& line_;
    FaultInjector* faults_;
    device::LineSink&
        sink_;  ///< Takes the bytes of the device: the faults, or without them the line.
    TroubleHandler on_trouble_;
    int host_baud_ = 0;
    bool is_blocked_ = false;           ///< The terminal takes no more.
    bool is_waiting_for_baud_ = false;  ///< The device sends nothing at this speed of the terminal.
    Plug plug_ = Plug::in;
    FaultInjector::HangUp hang_up_;
    int turns_ = 0, quiet_turns_ = 0;  ///< While leaving: all turns; the last ones without unread.
    std::string trouble_;              ///< Reason that keeps it out.
    std::size_t bytes_unread_ = 0;
    Nanoseconds first_sent_{0}, last_sent_{0};
    std::optional<Nanoseconds> ended_at_;
    bool is_finished_ = false;
    bool was_drained_ = false;
};

}  // namespace a351::sim::line
