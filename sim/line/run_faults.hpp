#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/device/register_machine.hpp"
#include "sim/line/fault.hpp"
#include "sim/truth/truth_file.hpp"

namespace a351::sim::line {

/// Faults of the counter and of the flags.  They begin with the next frame, show from the frame
/// after it on, and end with the run of sampling.  Bits that they raised in DIAG_STAT then stay set
/// until the host reads them.
class RunFaults {
public:
    /// All arguments must outlive this.  @param by_kind  counts of affected frames or of faults.
    RunFaults(device::RegisterMachine& machine, const wire::DeviceProfile& profile,
              FaultCounts& by_kind);

    /// Adds a counter_jump, counter_stuck, counter_reset or error_flags.
    void add(const Fault& fault) { waiting_.push_back(fault); }

    /// Returns the number of faults that wait for a frame.
    [[nodiscard]] std::size_t waiting() const noexcept { return waiting_.size(); }

    /// Sets the fate of this frame by its counter, and prepares counter and flags for the next.
    void follow(truth::Record& frame);

    /// Begins the waiting faults with this frame, unless it was the last of its run of sampling.
    void begin_with(const truth::Record& frame);

private:
    /// State of one run of sampling.
    struct Begun {
        int run = 0;
        int stuck_frames = 0, stuck_left = 0;
        int flagged_left = 0;
        std::optional<truth::Fate> next;  ///< Fate of the next frame.
    };
    void follow_counter(truth::Record& frame);
    void follow_flags(const truth::Record& frame);
    void begin(const Fault& fault, const truth::Record& frame);
    void jump(std::uint16_t ticks, const truth::Record& frame);
    void count(FaultKind kind) { ++by_kind_[static_cast<std::size_t>(kind)]; }
    [[nodiscard]] std::uint16_t count_step() const;

    device::RegisterMachine& machine_;
    const wire::DeviceProfile& profile_;
    FaultCounts& by_kind_;
    std::vector<Fault> waiting_;
    Begun begun_;
};

}  // namespace a351::sim::line
