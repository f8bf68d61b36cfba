#include "sim/line/fault_schedule.hpp"

#include <algorithm>
#include <limits>

namespace a351::sim {

FaultSchedule::FaultSchedule(const FaultScript& script, UtcTime start) : planned_(script.planned) {
    for (const RandomFaults& faults : script.random) {
        random_.push_back(
            {faults.fault, faults.per_h, RandomStream(script.seed, faults.fault.name), start});
        draw_next(random_.back());
    }
    find_next();
}

void FaultSchedule::draw_next(RandomKind& kind) {
    constexpr double kSecondsPerHour = 3600.0;
    kind.next = later_by(kind.waits.exponential() * kSecondsPerHour / kind.per_h, kind.next);
}

void FaultSchedule::find_next() {
    next_at_ = UtcTime::max();
    next_frame_ = std::numeric_limits<std::int64_t>::max();
    for (const PlannedFault& planned : planned_) {
        if (planned.at) next_at_ = std::min(next_at_, *planned.at);
        if (planned.at_frame) next_frame_ = std::min(next_frame_, *planned.at_frame);
    }
    for (const RandomKind& kind : random_) next_at_ = std::min(next_at_, kind.next);
}

std::optional<Fault> FaultSchedule::take_due(UtcTime now, std::int64_t frames_made) {
    if (now < next_at_ && frames_made < next_frame_) return std::nullopt;
    std::optional<Fault> due;
    if (frames_made >= next_frame_) {
        const auto found = std::ranges::find(planned_, next_frame_, &PlannedFault::at_frame);
        due = found->fault;
        planned_.erase(found);
    } else if (const auto found = std::ranges::find(planned_, next_at_, &PlannedFault::at);
               found != planned_.end()) {
        due = found->fault;
        planned_.erase(found);
    } else {
        const auto kind = std::ranges::find(random_, next_at_, &RandomKind::next);
        due = kind->fault;
        draw_next(*kind);
    }
    find_next();
    return due;
}

}  // namespace a351::sim
