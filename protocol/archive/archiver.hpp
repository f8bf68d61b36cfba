#pragma once
/// @file
/// Journal chunks -> frames -> indices -> times -> miniSEED records.  One implementation for the
/// running daemon, recovery, the simulator's direct writer and re-timing: the archive is a pure
/// function of the journal.  No I/O; records and samples go to a sink.
///
///     Archiver archiver(sink);
///     while (const auto chunk = chunks.next()) archiver.take(*chunk);
///     archiver.close_records();
///
/// The records do not depend on where the reads are divided into chunks (archiver_test.cpp).  They
/// depend on where close_records() is called, and on the records that the sink already holds.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "protocol/archive/miniseed.hpp"
#include "protocol/journal/journal.hpp"
#include "protocol/timing/sample_clock.hpp"
#include "protocol/wire/burst_frame.hpp"

namespace a351::archive {

class Retiming;
class TimeGate;

/// Sample with its index, before packing.
struct Sample {
    std::int64_t index = 0;    ///< Index since the run began, from 0; gaps are counted.
    wire::BurstValues values;  ///< Raw counts; fields that the layout lacks are 0.
};

/// Receives the records and samples of an archiver, in order.
///
/// Records of one channel come in the order of their samples; those of several channels alternate.
/// An exception passes through to the caller of Archiver::take() or close_records().
class Sink {
public:
    virtual ~Sink() = default;
    /// Takes a finished record; `last_index` is its last sample.  The references are valid during
    /// the call only.  The sequence number in the record is 1.
    virtual void record(const std::string& channel, const PackedRecord& record,
                        std::int64_t last_index) = 0;
    /// Takes a sample once its index is known, even if its record will be withheld.  Its time may
    /// still be provisional, see Archiver::are_times_fixed().  The default does nothing.
    virtual void sample(const Sample&) {}
    /// Returns the number of samples of the record with this start, if the archive already holds
    /// it.  The archiver ends its own record at the same sample, so that a replay makes the same
    /// records.  The default holds no records.
    [[nodiscard]] virtual std::optional<std::size_t> samples_in_archive(const std::string&,
                                                                        UtcTime) const {
        return std::nullopt;
    }
};

/// Counts since construction.  bytes = framed + skipped + pending.  They never decrease, and a new
/// session does not reset them.
struct Counters {
    std::uint64_t bytes = 0;            ///< Bytes received.
    std::uint64_t frames = 0;           ///< Accepted frames, duplicates and anomalies included.
    std::uint64_t bytes_skipped = 0;    ///< Bytes of no frame, or of no session.
    std::uint64_t checksum_errors = 0;  ///< Runs of skipped bytes that begin with a wrong checksum.
    std::uint64_t framing_errors = 0;   ///< Start or end byte missing, or never confirmed.
    std::uint64_t gaps = 0;             ///< Places within a run where samples are missing.
    std::uint64_t samples_missing = 0;  ///< Samples missing there, frames that are not data too.
    std::uint64_t duplicates = 0;       ///< Dropped frames with the COUNT of the frame before.
    std::uint64_t anomalies = 0;        ///< Dropped frames whose COUNT fits no sample.
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
/// A record ends when it is full, at a missing sample, at UTC midnight, at a change of header, and
/// in close_records().  It also ends when its oldest sample is as old as
/// journal::Header::record_age, or no sample came for that time, but not before the times are
/// fixed.
///
/// Frames flagged ALIASI_ERR, or with an axis at 0x64000000, are not data (M-A352AD10 data sheet,
/// FLAG and output range): they leave a gap.
///
/// A frame arrives with the read that has its last byte, less the wire time of later bytes of that
/// read.  SampleClock removes the fixed delay: group delay of the filter + delay of data ready +
/// wire time of a frame.
///
/// Within a journal session, a restart of the device (SampleIndex: new_session), another boot of
/// the host or a changed layout starts index and clock again, as a new session.
///
/// Memory: less than 721 samples per channel, and the times of 24 h (3.5 MB).  Not thread-safe.
class Archiver {
public:
    /// Begins without a session: bytes before the first header are counted as skipped.
    /// @param sink      must outlive this.
    /// @param retiming  if given, it collects the data it needs; in its second pass it sets the
    ///                  times.  It must outlive this.
    explicit Archiver(Sink& sink, Retiming* retiming = nullptr);
    /// Drops open records; close_records() must be called before if nothing replays the journal.
    ~Archiver();

    /// Takes the next chunk, in the order of the journal.  A header of another session closes all
    /// open records and starts the index again.  Chunks of commands, sample times, events and marks
    /// are ignored.
    ///
    /// Cost: O(bytes of the chunk), plus the records that become complete.
    /// @throws InputError  a header names an unknown profile, layout, rate or baud rate.  Bytes are
    ///                     then counted as skipped until a valid header.
    void take(const journal::Chunk& chunk);

    /// Closes the open records: at a clean shutdown, or at the end of a journal that will not grow.
    /// The session is not ended: the next sample begins a new record of the same run.
    void close_records();

    /// Returns true if no time of a sample taken so far can change any more, also before the first
    /// sample.  If the stream may continue, close records only then.
    [[nodiscard]] bool are_times_fixed() const noexcept;

    /// Returns the counters; the reference is valid as long as this.
    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    /// Returns the index of the newest frame placed; std::nullopt before the first one of a run.
    [[nodiscard]] std::optional<std::int64_t> last_index() const noexcept;

    /// Returns the clock of the current session; null before the first header.  The pointer is
    /// valid until the next call of take().
    [[nodiscard]] timing::SampleClock* clock() noexcept;

private:
    class Session;
    Counters counters_;
    std::unique_ptr<TimeGate> gate_;
    Retiming* retiming_;
    std::unique_ptr<Session> session_;
};

}  // namespace a351::archive
