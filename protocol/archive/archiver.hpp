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

/// A placed sample, before packing.
struct Sample {
    std::int64_t index = 0;
    wire::BurstValues values;
};

/// Takes what the archiver makes, in order.
class ArchiveSink {
public:
    virtual ~ArchiveSink() = default;
    /// A finished record; `last_index` is its last sample.
    virtual void record(const std::string& channel, const PackedRecord& record,
                        std::int64_t last_index) = 0;
    virtual void sample(const Sample&) {}
    /// Samples of the record with this start if the archive holds it already: the archiver ends
    /// its own at the same sample, so that a replay runs into the records that are there.
    [[nodiscard]] virtual std::optional<std::size_t> samples_held(const std::string&,
                                                                  UtcTime) const {
        return std::nullopt;
    }
};

/// Everything that was counted since construction.  bytes = framed + skipped + pending.
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
    std::uint64_t integer_records = 0;  ///< Records that Steim-2 could not hold.
    std::uint64_t error_flags = 0;      ///< Frames with EA, ALIASI_ERR or an alarm.
    std::uint64_t sessions = 0;         ///< Started, device restarts included.
    /// Records with impossible times, of a host without a clock: in the journal only.
    std::uint64_t records_withheld = 0;
};

/// Channels: band code by output rate (B below 80 Hz, H, C from 250, F from 1000), N and the axis
/// suffix of the header; the raw temperature is K1.  Only fields of the layout.
///
/// A record ends when it is full, at a missing sample, at UTC midnight, when its oldest sample is
/// 60 s of data old or none came for 60 s, at a change of header, and in close_records().  Frames
/// flagged ALIASI_ERR, or with an axis at 0x64000000, are no data (M-A352AD10 data sheet, FLAG and
/// output range): they leave a gap.
///
/// A frame's arrival is that of the read with its last byte, less the wire time of what follows in
/// that read.  The fixed delay that SampleClock removes: group delay of the filter + wire time of a
/// frame.
///
/// Within a journal session, a device that restarted (SampleIndex: new_session) or another boot of
/// the host starts index and clock anew, as a session of its own; so does a changed layout.
class Archiver {
public:
    /// @param retiming  if given, gathers what it needs, or in its second pass gives the times.
    explicit Archiver(ArchiveSink& sink, Retiming* retiming = nullptr);
    ~Archiver();

    /// A header of another session closes all open records and starts the index anew.
    /// @throws InputError  a header names an unknown profile, layout, rate or baud rate.
    void take(const JournalChunk& chunk);

    /// Closes the open records: clean shutdown, or the end of a journal that will not grow.
    void close_records();

    /// Whether no time of a sample taken so far will be another once more is known: of a stream that
    /// may go on, no other records may be closed.
    [[nodiscard]] bool are_times_fixed() const noexcept;

    [[nodiscard]] const ArchiverCounters& counters() const noexcept;
    [[nodiscard]] std::optional<std::int64_t> last_index() const noexcept;

    /// The clock of the current session; null before the first header.
    [[nodiscard]] timing::SampleClock* clock() noexcept;

private:
    class Session;
    ArchiverCounters counters_;
    std::unique_ptr<TimeGate> gate_;
    Retiming* retiming_;
    std::unique_ptr<Session> session_;
};

}  // namespace a351::record
