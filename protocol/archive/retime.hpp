#pragma once
/// @file
/// The archive of a data root again, with times computed afterwards.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "protocol/archive/archiver.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal_reader.hpp"
#include "protocol/timing/hindsight.hpp"

namespace a351::record {

/// Two passes of an archiver over a journal: the first one collects the data from which the times
/// of the second one are computed.
///
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
    void begin_second_pass() { is_second_pass_ = true; }

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

struct RetimeReport {
    std::uint64_t segments = 0;
    std::uint64_t records = 0;
    std::vector<JournalDamage> damage;  ///< Segments that end early.
    ArchiverCounters counters;
};

/// Writes the archive of a data root again, with times computed afterwards: each second from the
/// arrivals 450 s before and after it, and from the readings at which the host's clock was
/// synchronised.  Samples, gaps and channels are those of the running daemon; records may end at
/// other samples.  Events keep their samples and get the new times; metadata are copied.  The
/// journal is not copied.
///
/// The result is complete or absent: it is written beside `out` and renamed at the end.
///
/// @throws InputError         no journal in `root`, or `out` exists.
/// @throws std::system_error  a file cannot be read or written.
RetimeReport retime(FileLayer& files, const std::filesystem::path& root,
                    const std::filesystem::path& out);

}  // namespace a351::record
