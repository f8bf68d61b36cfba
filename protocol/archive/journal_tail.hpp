#pragma once
/// @file
/// Samples that were journaled and have not reached the archive, for a computation that runs while
/// the daemon records.
///
///     ChannelData data = read_channel(archive, codes, "BNZ", from, to);   // first
///     const JournalTail tail(journal, codes, last_sample, to);            // then
///     tail.append_to(data, "BNZ", from, to);
///
/// Everything in the archive was journaled before, so no sample is missing between the two.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::archive {

/// Returns the newest reading of the host's clock in a journal: at most a second before its end.
/// std::nullopt without a segment that can be read.
/// @throws std::system_error  the directory or a segment cannot be read.
[[nodiscard]] std::optional<UtcTime> journal_end(const std::filesystem::path& journal);

/// The end of a journal, archived in memory by the daemon's own Archiver.  Nothing is written.
///
/// A torn chunk at the end of the newest segment is one that the daemon is writing: it ends the
/// tail and is no error.
///
/// Memory: the samples of the tail.  Not changed after construction, so threads may share it.
class JournalTail {
public:
    /// Reason: the time to read a session grows with its length, and most survey days are shorter.
    /// The last 15 minutes of a longer one give times within 0.2 ms of the archive's.
    static constexpr std::chrono::hours kLongestSession{12};

    /// Reads the journal from the begin of the session until `to`, so that the times are those that
    /// the archive will have, to the nanosecond.  If the session began more than `longest_session`
    /// before `from`, it reads from 15 minutes before `from`: the times of samples come mainly from
    /// the arrivals of the last 15 minutes (ArrivalEdge).
    /// @param codes  records of other stations are ignored.
    /// @throws std::system_error  a segment cannot be read.
    JournalTail(const std::filesystem::path& journal, const journal::StationCodes& codes,
                UtcTime from, UtcTime to, Nanoseconds longest_session = kLongestSession);

    /// Appends the samples of a channel that follow the archived ones.
    ///
    /// The last archived samples are searched for in the tail.  If they are there, all times of
    /// their run are shifted so that these have the times of the archive; the shift is zero, or the
    /// difference that a start 15 minutes before makes (journal_tail_test.cpp: below 0.2 ms).  Else
    /// the samples after the last archived one are appended with the tail's times.
    /// @param data      as read_channel() returned it for [from, to).
    /// @param from, to  samples outside [from, to) are not appended.
    void append_to(ChannelData& data, const std::string& channel, UtcTime from, UtcTime to) const;

    /// Returns the newest clock reading of the journal, as journal_end() at the time when it was
    /// read; std::nullopt if the journal continued after `to`.
    [[nodiscard]] const std::optional<UtcTime>& end() const noexcept { return end_; }

private:
    using Runs = std::map<std::uint64_t, ChannelData>;  ///< Key: number of the run.
    struct Gather;

    std::map<std::string, Runs, std::less<>> channels_;
    std::optional<UtcTime> end_;
};

}  // namespace a351::archive
