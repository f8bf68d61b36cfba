#include "sim/line/run_faults.hpp"

#include <utility>

namespace a351::sim::line {
namespace {

constexpr unsigned kHalfRange = 0x8000;

/// Returns the fate of a frame whose COUNT is `ticks` after that of the frame before.
truth::Fate fate_of(std::uint16_t ticks, std::uint16_t step) {
    if (ticks == 0) return truth::Fate::repeated;
    return ticks % step == 0 && ticks < kHalfRange ? truth::Fate::intact : truth::Fate::misplaced;
}

}  // namespace

RunFaults::RunFaults(device::RegisterMachine& machine, const wire::DeviceProfile& profile,
                     FaultCounts& by_kind)
    : machine_(machine), profile_(profile), by_kind_(by_kind) {}

std::uint16_t RunFaults::count_step() const {
    return profile_.count_step(machine_.output_rate_hz());
}

void RunFaults::follow(truth::Record& frame) {
    if (begun_.run != machine_.sampling_run()) {
        begun_ = {};
        begun_.run = machine_.sampling_run();
    }
    follow_counter(frame);
    follow_flags(frame);
}

void RunFaults::follow_counter(truth::Record& frame) {
    if (begun_.stuck_left > 0) {
        frame.fate = truth::Fate::repeated;
        count(FaultKind::counter_stuck);
        const int steps = --begun_.stuck_left == 0 ? begun_.stuck_frames : -1;
        machine_.jump_counter(static_cast<std::uint16_t>(steps * count_step()));
    }
    if (const auto fate = std::exchange(begun_.next, std::nullopt)) frame.fate = *fate;
}

void RunFaults::follow_flags(const truth::Record& frame) {
    if (begun_.flagged_left == 0) return;
    if ((frame.values.flag & wire::kFlagError) == 0) {
        begun_.flagged_left = 0;  // The host has read DIAG_STAT, or frames carry no FLAG.
        return;
    }
    count(FaultKind::error_flags);
    if (--begun_.flagged_left == 0) machine_.clear_diagnostics();
}

void RunFaults::begin_with(const truth::Record& frame) {
    if (!machine_.is_sampling() || machine_.sampling_run() != begun_.run) return;
    for (const Fault& fault : std::exchange(waiting_, {})) begin(fault, frame);
}

void RunFaults::begin(const Fault& fault, const truth::Record& frame) {
    switch (fault.kind) {
        case FaultKind::counter_stuck:  // The next frames show the COUNT of this one.
            if (begun_.stuck_left > 0) return;
            begun_.stuck_frames = begun_.stuck_left = fault.count;
            return machine_.jump_counter(static_cast<std::uint16_t>(-count_step()));
        case FaultKind::error_flags:
            begun_.flagged_left = fault.count;
            return machine_.raise_diagnostics(static_cast<std::uint16_t>(fault.diag_stat));
        case FaultKind::counter_reset:
            jump(static_cast<std::uint16_t>(-machine_.value_of(device::kCount)), frame);
            break;
        default: {
            const int ticks = fault.ticks > 0 ? fault.ticks : fault.count * count_step();
            jump(static_cast<std::uint16_t>(ticks & 0xFFFF), frame);
        }
    }
    count(fault.kind);
}

void RunFaults::jump(std::uint16_t ticks, const truth::Record& frame) {
    machine_.jump_counter(ticks);
    const int next = machine_.value_of(device::kCount) + count_step();
    begun_.next = fate_of(static_cast<std::uint16_t>(next - frame.values.count), count_step());
}

}  // namespace a351::sim::line
