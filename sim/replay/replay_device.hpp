#pragma once
/// @file
/// A recording with the handshake of the live device.  No I/O of its own and no clock.

#include <cstdint>
#include <memory>

#include "sim/replay/recording.hpp"

namespace a351::sim::replay {

enum class Timing {
    as_recorded,      ///< Each piece leaves when simulated time reaches its recorded instant.
    from_host_start,  ///< The same, with recorded time shifted to the host's start of sampling.
    as_fast_as_read,  ///< Each piece leaves as soon as the line takes it.
};

struct Report {
    std::int64_t pieces = 0;  ///< Reads of a journal, samples of an archive.
    int sessions = 0;         ///< Sessions begun.
    int restarts = 0;         ///< Starts of sampling by the host when a session's pieces were due.
    Nanoseconds longest_delay{0};  ///< Largest delay of a piece at such a start, simulated.
};

/// Answers commands as the recorded unit does in configuration mode.  The recording is sent while
/// the host samples with the recorded settings.  A piece that was due before is sent at once, so
/// that nothing is left out if the host is late.
///
/// A command while the recording is sent comes from a host that stops, or that took a paused replay
/// for a silent sensor and reads no frames until it has configured the sensor.  Therefore any
/// command ends sampling, and bytes that the host has not seen are taken back from the line.  When
/// the host starts sampling again, they and the next piece follow.  Nothing is sent while the
/// host's terminal has another baud rate.
///
/// At the end of a session the device is silent in configuration mode; the next session begins when
/// the host starts sampling again.
class Device final : public device::LineDevice {
public:
    /// @param now  time on the steady clock of Instant.
    Device(std::unique_ptr<Recording> recording, Timing timing, Nanoseconds now);

    /// @throws std::runtime_error  sampling was started with settings other than the recorded ones;
    ///         one line that names both.
    void receive(std::span<const std::byte> bytes, const device::Instant& now,
                 device::LineSink& line) override;
    void advance_to(const device::Instant& now, device::LineSink& line) override;
    [[nodiscard]] std::optional<UtcTime> next_due() const override;
    [[nodiscard]] int baud() const override { return machine_->baud(); }
    [[nodiscard]] bool waits_for_baud() const override { return true; }

    /// Returns when the first piece is due, by the recording's clock.
    [[nodiscard]] UtcTime first_due() const noexcept { return first_due_; }

    [[nodiscard]] const Recording& recording() const noexcept { return *recording_; }
    [[nodiscard]] const Report& report() const noexcept { return report_; }

private:
    void install_unit(Nanoseconds now);
    void begin_sampling(UtcTime now);
    void end_session(Nanoseconds now);
    [[nodiscard]] UtcTime simulated(UtcTime recorded) const;

    std::unique_ptr<Recording> recording_;
    Timing timing_;
    std::unique_ptr<device::RegisterMachine> machine_;
    int run_ = 0;             ///< Sampling run of the machine that was last seen to begin.
    bool has_begun_ = false;  ///< The current session has begun.
    bool is_over_ = false;    ///< There is no further session.
    Nanoseconds shift_{0};    ///< Simulated minus recorded time.
    UtcTime first_due_;
    UtcTime sampling_since_;
    UtcTime now_;  ///< Simulated time of the last call.
    std::vector<std::byte> answers_;
    std::vector<std::byte> taken_back_;  ///< Recorded bytes to send before the next piece.
    Report report_;
};

}  // namespace a351::sim::replay
