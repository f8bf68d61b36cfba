#include "protocol/archive/retiming.hpp"

#include "protocol/core/input_error.hpp"

namespace a351::record {

void Retiming::begin_run(const JournalHeader& header, timing::SampleClockOptions options,
                         timing::SampleClock& clock) {
    if (!is_second_pass_) {
        const std::size_t sleeps = histories_[header.boot_id].sleeps();
        runs_.push_back({header.session, header.boot_id, timing::Hindsight(options, sleeps), {}});
        return;
    }
    if (next_run_ == runs_.size())
        throw InputError(
            "the journal grew while it was read; allowed: a journal to which no daemon writes");
    Run& run = runs_[next_run_++];
    const timing::UtcHistory& history = histories_[run.boot_id];
    if (history.is_empty()) return;
    clock.use(run.hindsight.times(history), history.is_synchronised());
    run.hindsight = timing::Hindsight(options, 0);  // no longer needed
    run.clock = clock;
}

void Retiming::observe_clock(const timing::ClockReading& reading) {
    if (is_second_pass_) return;
    Run& run = runs_.back();
    timing::UtcHistory& history = histories_[run.boot_id];
    const std::size_t sleeps = history.sleeps();
    history.observe(reading);
    if (history.sleeps() != sleeps) run.hindsight.host_slept(history.sleeps());
}

void Retiming::observe(std::int64_t index, RawTime arrival) {
    if (!is_second_pass_) runs_.back().hindsight.observe(index, arrival);
}

void Retiming::begin_second_pass() { is_second_pass_ = true; }

std::optional<UtcTime> Retiming::time_of(const SessionId& session, std::int64_t index,
                                         UtcTime near) const {
    std::optional<UtcTime> nearest;
    for (const Run& run : runs_) {
        if (run.session != session || !run.clock) continue;
        const auto time = run.clock->time_of(index);
        if (!time) continue;
        if (!nearest || std::chrono::abs(time->utc - near) < std::chrono::abs(*nearest - near))
            nearest = time->utc;
    }
    return nearest;
}

}  // namespace a351::record
