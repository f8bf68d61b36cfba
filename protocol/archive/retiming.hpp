#pragma once
/// @file
/// Two passes of an archiver over a journal: the first one collects the data from which the times
/// of the second one are computed.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "protocol/journal/journal.hpp"
#include "protocol/timing/hindsight.hpp"

namespace a351::record {

/// Collects the runs of the sensor in order, and clock readings per boot of the host; one boot may
/// have several runs.
class Retiming {
public:
    /// Begins a run, whose index starts at 0.  In the second pass `clock` gets the times of this
    /// run.
    void begin_run(const JournalHeader& header, timing::SampleClockOptions options,
                   timing::SampleClock& clock);
    void observe_clock(const timing::ClockReading& reading);
    void observe(std::int64_t index, RawTime arrival);

    /// Begins the second pass: the same chunks follow again, from the first one.
    void begin_second_pass();

    /// Returns the new time of a sample; to be called after the second pass.  If a session has
    /// several runs with this index, it is the time nearest to `near`.  std::nullopt for an unknown
    /// session.
    [[nodiscard]] std::optional<UtcTime> time_of(const SessionId& session, std::int64_t index,
                                                 UtcTime near) const;

private:
    struct Run {
        SessionId session;
        std::string boot_id;
        timing::Hindsight hindsight;
        std::optional<timing::SampleClock> clock;  ///< Clock of the second pass.
    };
    bool is_second_pass_ = false;
    std::map<std::string, timing::UtcHistory> histories_;
    std::vector<Run> runs_;
    std::size_t next_run_ = 0;
};

}  // namespace a351::record
