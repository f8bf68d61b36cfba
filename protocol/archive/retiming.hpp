#pragma once
/// @file
/// Two passes of an archiver over a journal: the first one gathers what the second one's times are
/// made of.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "protocol/journal/journal.hpp"
#include "protocol/timing/hindsight.hpp"

namespace a351::record {

/// Runs of the sensor, in order; their clock readings by boots of the host, which outlast runs.
class Retiming {
public:
    /// An index begins at 0.  In the second pass `clock` takes over the times of this run.
    void begin_run(const JournalHeader& header, timing::SampleClockOptions options,
                   timing::SampleClock& clock);
    void observe_clock(const timing::ClockReading& reading);
    void observe(std::int64_t index, RawTime arrival);

    /// The same chunks follow again, from the first.
    void begin_second_pass();

    /// After the second pass.  A session may have several runs: of their samples with this index,
    /// the one nearest to `near`.  std::nullopt for a session that was not met.
    [[nodiscard]] std::optional<UtcTime> time_of(const SessionId& session, std::int64_t index,
                                                 UtcTime near) const;

private:
    struct Run {
        SessionId session;
        std::string boot_id;
        timing::Hindsight hindsight;
        std::optional<timing::SampleClock> clock;  ///< Of the second pass.
    };
    bool is_second_pass_ = false;
    std::map<std::string, timing::UtcHistory> histories_;
    std::vector<Run> runs_;
    std::size_t next_run_ = 0;
};

}  // namespace a351::record
