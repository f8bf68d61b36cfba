#pragma once
/// @file
/// Journal chunks -> frames -> indices -> times -> miniSEED records.  One implementation for the
/// running daemon, recovery, the simulator's direct writer and re-timing: the archive is a pure
/// function of the journal.  No I/O; records and samples go to a sink.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "protocol/archive/miniseed.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/timing/sample_clock.hpp"
#include "protocol/wire/burst_frame.hpp"

namespace a351::record {

class Retiming;
class TimeGate;

/// Sample with its index, before packing.
struct Sample {
    std::int64_t index = 0;
    wire::BurstValues values;
};

/// Receives the records and samples of an archiver, in order.
class ArchiveSink {
public:
    virtual ~ArchiveSink() = default;
    /// Takes a finished record; `last_index` is its last sample.
    virtual void record(const std::string& channel, const PackedRecord& record,
                        std::int64_t last_index) = 0;
    virtual void sample(const Sample&) {}
    /// Returns the number of samples of the record with this start, if the archive already holds
    /// it.  The archiver ends its own record at the same sample, so that a replay makes the same
    /// records.
    [[nodiscard]] virtual std::optional<std::size_t> samples_in_archive(const std::string&,
                                                                        UtcTime) const {
        return std::nullopt;
    }
};

/// Counts since construction.  bytes = framed + skipped + pending.
struct ArchiverCounters {
    std::uint64_t bytes = 0;
    std::uint64_t frames = 0;
    std::uint64_t bytes_skipped = 0;
    std::uint64_t checksum_errors = 0;
    std::uint64_t framing_errors = 0;  ///< Start or end byte missing, or never confirmed.
    std::uint64_t gaps = 0;
    std::uint64_t samples_missing = 0;
    std::uint64_t duplicates = 0;
    std::uint64_t anomalies = 0;
    std::uint64_t integer_records = 0;  ///< Records coded as integers instead of Steim-2.
    std::uint64_t error_flags = 0;      ///< Frames with EA, ALIASI_ERR or an alarm.
    std::uint64_t sessions = 0;         ///< Sessions started, restarts of the device included.
    /// Records with impossible times, because the host had no clock: kept in the journal only.
    std::uint64_t records_withheld = 0;
};

/// Makes miniSEED records of journal chunks.
///
/// Channels: band code by output rate (B below 80 Hz, H, C from 250, F from 1000), then N and the
/// axis suffix of the header, or K1 for the raw temperature.  Only fields of the layout have one.
///
/// A record ends when it is full, at a missing sample, at UTC midnight, when its oldest sample is
/// 60 s of data old or none came for 60 s, at a change of header, and in close_records().  Frames
/// flagged ALIASI_ERR, or with an axis at 0x64000000, are not data (M-A352AD10 data sheet, FLAG and
/// output range): they leave a gap.
///
/// A frame arrives with the read that has its last byte, less the wire time of later bytes of that
/// read.  SampleClock removes the fixed delay: group delay of the filter + delay of data ready +
/// wire time of a frame.
///
/// Within a journal session, a restart of the device (SampleIndex: new_session), another boot of
/// the host or a changed layout starts index and clock again, as a new session.
class Archiver {
public:
    /// @param retiming  if given, it collects the data it needs; in its second pass it sets the
    ///                  times.
    explicit Archiver(ArchiveSink& sink, Retiming* retiming = nullptr);
    ~Archiver();

    /// Takes the next chunk.  A header of another session closes all open records and starts the
    /// index again.
    /// @throws InputError  a header names an unknown profile, layout, rate or baud rate.
    void take(const JournalChunk& chunk);

    /// Closes the open records: at a clean shutdown, or at the end of a journal that will not grow.
    void close_records();

    /// Returns true if no time of a sample taken so far can change any more.  If the stream may
    /// continue, close records only then.
    [[nodiscard]] bool are_times_fixed() const noexcept;

    [[nodiscard]] const ArchiverCounters& counters() const noexcept { return counters_; }
    [[nodiscard]] std::optional<std::int64_t> last_index() const noexcept;

    /// Returns the clock of the current session; null before the first header.
    [[nodiscard]] timing::SampleClock* clock() noexcept;

private:
    class Session;
    ArchiverCounters counters_;
    std::unique_ptr<TimeGate> gate_;
    Retiming* retiming_;
    std::unique_ptr<Session> session_;
};

}  // namespace a351::record
