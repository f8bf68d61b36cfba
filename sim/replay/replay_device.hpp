#pragma once
/// @file
/// A recording behind the handshake of the live device.  No I/O of its own and no clock.

#include <cstdint>
#include <memory>

#include "sim/replay/recording.hpp"

namespace a351::sim {

enum class ReplayTiming {
    as_recorded,      ///< Each piece leaves at its recorded instant on simulated time.
    from_host_start,  ///< The same, but simulated time is that of the recording when the host begins.
    as_fast_as_read,  ///< Whenever the line takes more.
};

struct ReplayReport {
    std::int64_t pieces = 0;  ///< Reads of a journal, samples of an archive.
    int sessions = 0;         ///< Begun.
};

/// Answers commands as the recorded unit in configuration mode.  What was recorded flows while the
/// host samples with the recorded settings: a piece that fell due before follows at once, so that
/// nothing is left out however late the host comes, and when it stops and starts again the next
/// piece follows.  A session that ends leaves the device in configuration mode, silent; the next one
/// begins once it has been started anew.
class ReplayDevice final : public LineDevice {
public:
    /// @param now  on the steady clock of Instant.
    ReplayDevice(std::unique_ptr<Recording> recording, ReplayTiming timing, Nanoseconds now);

    /// @throws std::runtime_error  sampling was started with settings other than the recorded ones;
    ///         one line with both.
    void receive(std::span<const std::byte> bytes, const Instant& now, LineSink& line) override;
    void advance_to(const Instant& now, LineSink& line) override;
    [[nodiscard]] std::optional<UtcTime> next_due() const override;
    [[nodiscard]] int baud() const override { return machine_->baud(); }

    /// Of the first piece, by the recording's clock.
    [[nodiscard]] UtcTime first_due() const noexcept { return first_due_; }

    [[nodiscard]] const Recording& recording() const noexcept { return *recording_; }
    [[nodiscard]] const ReplayReport& report() const noexcept { return report_; }

private:
    void put_in_place(Nanoseconds now);
    void begin_sampling(UtcTime now);
    void end_session(Nanoseconds now);
    [[nodiscard]] UtcTime simulated(UtcTime recorded) const;

    std::unique_ptr<Recording> recording_;
    ReplayTiming timing_;
    std::unique_ptr<RegisterMachine> machine_;
    int run_ = 0;             ///< Of the machine, the last one seen to begin.
    bool has_begun_ = false;  ///< The session has.
    bool is_over_ = false;    ///< There is no further session.
    Nanoseconds shift_{0};    ///< Simulated minus recorded time.
    UtcTime first_due_;
    UtcTime sampling_since_;
    UtcTime now_;  ///< Simulated, of the last call.
    std::vector<std::byte> answers_;
    ReplayReport report_;
};

}  // namespace a351::sim
