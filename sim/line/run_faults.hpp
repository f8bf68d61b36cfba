#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/device/register_machine.hpp"
#include "sim/line/fault.hpp"
#include "sim/truth/truth_file.hpp"

namespace a351::sim {

/// Faults of the counter and of the flags.  They begin with the next frame, show from the one
/// behind it on, and end with the stay in sampling mode: what they raised in DIAG_STAT is then the
/// host's to read.
class RunFaults {
public:
    /// All must outlive this.  @param by_kind  frames, or times, are counted there.
    RunFaults(RegisterMachine& machine, const wire::DeviceProfile& profile, FaultCounts& by_kind);

    /// counter_jump, counter_stuck, counter_reset or error_flags.
    void add(const Fault& fault) { waiting_.push_back(fault); }

    /// Says what the counter of this frame is worth, and moves counter and flags on for the next.
    void follow(TruthRecord& frame);

    /// What waits begins with this frame, unless it was the last of its stay.
    void begin_with(const TruthRecord& frame);

private:
    /// Of one stay in sampling mode.
    struct Begun {
        int run = 0;
        int stuck_frames = 0, stuck_left = 0;
        int flagged_left = 0;
        std::optional<Fate> next;  ///< Of the next frame.
    };
    void follow_counter(TruthRecord& frame);
    void follow_flags(const TruthRecord& frame);
    void begin(const Fault& fault, const TruthRecord& frame);
    void jump(std::uint16_t ticks, const TruthRecord& frame);
    void count(FaultKind kind) { ++by_kind_[static_cast<std::size_t>(kind)]; }
    [[nodiscard]] std::uint16_t count_step() const;

    RegisterMachine& machine_;
    const wire::DeviceProfile& profile_;
    FaultCounts& by_kind_;
    std::vector<Fault> waiting_;
    Begun begun_;
};

}  // namespace a351::sim
