#pragma once
/// @file
/// Between device and line: does to frames, device and line what a script or somebody asks for,
/// and keeps count of it.  No I/O and no clock.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/device/register_machine.hpp"
#include "sim/line/fault_schedule.hpp"
#include "sim/line/frame_damage.hpp"
#include "sim/line/line.hpp"
#include "sim/line/run_faults.hpp"

namespace a351::sim {

struct AppliedFault {
    std::string name;
    UtcTime at;                    ///< Simulated.
    std::int64_t frames_made = 0;  ///< By the device until then.
};

/// A fault of the script that could not be had.
struct RefusedFault {
    std::string name;
    UtcTime at;  ///< Simulated.
    std::string reason;
};

struct FaultReport {
    /// Frames that each kind touched, by FaultKind; of kinds that touch none, how often it happened.
    FaultCounts by_kind{};
    std::int64_t bytes_dropped = 0;
    std::int64_t bytes_inserted = 0;
    std::int64_t bytes_garbage = 0;
    std::int64_t frames_cut = 0;  ///< By answers.
    std::vector<AppliedFault> applied;
    std::vector<RefusedFault> refused;
};

/// A frame suffers one fault at most: those that wait take the next frames in turn.  What happens
/// to the device because of a frame shows from the next one on.
class FaultInjector final : public LineSink {
public:
    /// Takes an oven fault by name; false when the oven knows none such.
    using OvenHandler = std::function<bool(std::string_view kind, int count)>;

    /// The port is pulled out until then.
    struct HangUp {
        UtcTime until;
        bool loses_power = false;
    };

    /// `line`, `machine` and `profile` must outlive this.  @param start  of the simulation.
    FaultInjector(const FaultScript& script, UtcTime start, Line& line, RegisterMachine& machine,
                  const wire::DeviceProfile& profile, MachineIdentity identity, OvenHandler oven);
    FaultInjector(const FaultInjector&) = delete;
    FaultInjector& operator=(const FaultInjector&) = delete;

    void send(std::span<const std::byte> bytes, UtcTime leaves, const TruthRecord* frame) override;
    [[nodiscard]] bool is_full() const override { return line_.is_full(); }

    /// To be called before the device is served: faults of the device happen at this steady time.
    void begin(const Instant& now) { steady_ = now.steady; }

    /// To be called after it was: faults that are due although no frames come.
    void catch_up(const Instant& now);

    /// One more fault, now.
    /// @throws InputError         the oven knows no such fault, or its link is taken.
    /// @throws std::system_error  the oven's terminal.
    void apply(const Fault& fault, UtcTime simulated);

    /// What the port has to do, once.
    [[nodiscard]] std::optional<HangUp> take_hang_up();

    /// The port has done it and is plugged in again.
    void came_back(const HangUp& hang_up, const Instant& now);

    /// The receiver loses what it has no room for.
    [[nodiscard]] bool is_overrun(UtcTime now) const noexcept { return now < overrun_until_; }

    [[nodiscard]] const FaultReport& report() const noexcept { return report_; }

private:
    struct Waiting {
        Fault fault;
        int frames = 0;  ///< Still to suffer it.
    };
    struct HeldFrame {
        Bytes bytes;
        TruthRecord truth;
    };
    void send_frame(std::span<const std::byte> bytes, UtcTime leaves, TruthRecord truth);
    void spoil(const Fault& fault, std::span<const std::byte> bytes, UtcTime leaves,
               TruthRecord truth);
    void send_answer(std::span<const std::byte> bytes, UtcTime leaves);
    void release_answer(UtcTime leaves);
    void release_held(UtcTime leaves);
    void apply_due(UtcTime now, UtcTime leaves);
    void pull_out(const HangUp& asked, UtcTime simulated);
    void put_other_unit();
    void count(FaultKind kind) { ++report_.by_kind[static_cast<std::size_t>(kind)]; }
    [[nodiscard]] bool sends_frames() const;

    FaultSchedule schedule_;
    bool answers_cut_frames_;
    Line& line_;
    RegisterMachine& machine_;
    const wire::DeviceProfile& profile_;
    MachineIdentity identity_;
    OvenHandler oven_;
    RandomStream places_;
    Nanoseconds steady_{0};
    std::int64_t frames_made_ = 0;
    UtcTime last_frame_;  ///< When the last one left.

    std::vector<Waiting> waiting_;
    std::optional<HeldFrame> held_frame_;  ///< To be sent behind its successor.
    Bytes held_answer_;                    ///< To be sent within the next frame.
    UtcTime muted_until_, overrun_until_;
    std::optional<HangUp> hang_up_;
    bool is_unit_waiting_ = false;
    FaultReport report_;
    RunFaults run_faults_;
};

}  // namespace a351::sim
