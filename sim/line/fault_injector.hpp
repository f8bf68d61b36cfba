#pragma once
/// @file
/// Stage between device and line: applies and counts the faults of frames, device and line that a
/// script or the control socket asks for.  No I/O and no clock.

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/device/register_machine.hpp"
#include "sim/line/fault_script.hpp"
#include "sim/line/frame_damage.hpp"
#include "sim/line/line.hpp"
#include "sim/line/run_faults.hpp"

namespace a351::sim::line {

struct AppliedFault {
    std::string name;
    UtcTime at;                    ///< Simulated.
    std::int64_t frames_made = 0;  ///< Frames that the device had made by then.
};

/// A fault of the script that could not be applied, or found no frame in time.
struct RefusedFault {
    std::string name;
    UtcTime at;  ///< Simulated.
    std::string reason;
};

struct FaultReport {
    /// Frames that each kind affected, by FaultKind; for kinds without frames, number of faults.
    FaultCounts by_kind{};
    std::int64_t bytes_dropped = 0;
    std::int64_t bytes_inserted = 0;
    std::int64_t bytes_garbage = 0;
    std::int64_t frames_cut = 0;        ///< Frames cut by answers.
    std::vector<AppliedFault> applied;  ///< The first kMostListed.
    std::vector<RefusedFault> refused;  ///< The first kMostListed.
    std::int64_t applied_in_all = 0;    ///< Including those not listed.
    std::int64_t refused_in_all = 0;

    /// Most faults of a list: those of a day with one in 9 s.  Their JSON takes 5 MB.
    static constexpr std::size_t kMostListed = 10'000;
};

/// A frame has one fault at most: waiting faults take the next frames in turn.  A fault of the
/// device that is triggered by a frame shows from the next frame on.
class FaultInjector final : public device::LineSink {
public:
    /// Most faults that wait for a frame: a second of frames at the highest output rate.  Random
    /// faults can be more frequent than frames; more are refused while so many wait.
    static constexpr std::size_t kMostWaiting = 1000;

    /// Applies an oven fault by name; returns false if the oven does not know it.
    using OvenHandler = std::function<bool(std::string_view kind, int count)>;

    /// A request to pull the port out until an instant.
    struct HangUp {
        UtcTime until;
        bool loses_power = false;
    };

    /// `line`, `machine` and `profile` must outlive this.  @param start  start of the simulation.
    FaultInjector(const FaultScript& script, UtcTime start, Line& line,
                  device::RegisterMachine& machine, const wire::DeviceProfile& profile,
                  device::MachineIdentity identity, OvenHandler oven);
    FaultInjector(const FaultInjector&) = delete;
    FaultInjector& operator=(const FaultInjector&) = delete;

    void send(std::span<const std::byte> bytes, UtcTime leaves,
              const truth::Record* frame) override;
    [[nodiscard]] bool is_full() const override { return line_.is_full(); }

    /// Sets the steady time of the next faults of the device.  Call it before the device is served.
    void begin(const device::Instant& now) { steady_ = now.steady; }

    /// Applies faults that are due although no frames come.  Call it after the device was served.
    void catch_up(const device::Instant& now);

    /// Applies a fault now.
    /// @throws InputError         the oven does not know the fault, or its link is taken; too many
    ///                            faults wait for a frame.
    /// @throws std::system_error  an operation on the oven's terminal failed.
    void apply(const Fault& fault, UtcTime simulated);

    /// Returns a new request to pull the port out; each request is returned once.
    [[nodiscard]] std::optional<HangUp> take_hang_up();

    /// Ends a hang-up: the port has been out as requested and is plugged in again.
    void end_hang_up(const HangUp& hang_up, const device::Instant& now);

    /// Returns true while the receiver loses bytes for which it has no room.
    [[nodiscard]] bool is_overrun(UtcTime now) const noexcept { return now < overrun_until_; }

    [[nodiscard]] const FaultReport& report() const noexcept { return report_; }

private:
    struct Waiting {
        Fault fault;
        int frames = 0;  ///< Frames still to damage.
    };
    struct HeldFrame {
        Bytes bytes;
        truth::Record truth;
    };
    void send_frame(std::span<const std::byte> bytes, UtcTime leaves, truth::Record truth);
    void spoil(const Fault& fault, std::span<const std::byte> bytes, UtcTime leaves,
               truth::Record truth);
    void send_answer(std::span<const std::byte> bytes, UtcTime leaves);
    void release_answer(UtcTime leaves);
    void release_held(UtcTime leaves);
    void apply_due(UtcTime now, UtcTime leaves);
    void require_room(const Fault& fault) const;
    void pull_out(const HangUp& asked, UtcTime simulated);
    void put_other_unit();
    void count(FaultKind kind) { ++report_.by_kind[static_cast<std::size_t>(kind)]; }
    [[nodiscard]] bool sends_frames() const;

    FaultSchedule schedule_;
    bool answers_cut_frames_;
    Line& line_;
    device::RegisterMachine& machine_;
    const wire::DeviceProfile& profile_;
    device::MachineIdentity identity_;
    OvenHandler oven_;
    noise::RandomStream places_;
    Nanoseconds steady_{0};
    std::int64_t frames_made_ = 0;
    UtcTime last_frame_;  ///< Instant at which the last frame left.

    std::deque<Waiting> waiting_;
    std::optional<HeldFrame> held_frame_;  ///< To be sent after the next frame.
    Bytes held_answer_;                    ///< To be sent within the next frame.
    UtcTime muted_until_, overrun_until_;
    std::optional<HangUp> hang_up_;
    bool is_unit_waiting_ = false;
    FaultReport report_;
    RunFaults run_faults_;
};

}  // namespace a351::sim::line
