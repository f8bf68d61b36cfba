#pragma once
/// @file
/// The records of an archive in the order in which they are sent, while a daemon writes it.
///
///     ArchiveStreams streams(root / "archive");
///     streams.look();
///     for (const std::string& name : streams.unplaced()) streams.place(name, last_sent(name));
///     while (const auto record = streams.next()) send(*record);
///
/// Nothing is written, and no lock is taken: the daemon is not disturbed.  A record that is only
/// partly written is left until it is complete.

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/archive/archive_reader.hpp"
#include "protocol/archive/miniseed.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::daemon::stream {

/// Identity of a record within its stream.
struct Mark {
    int sequence = 0;  ///< Sequence number, 1 ... 999999.
    UtcTime start;     ///< Time of the first sample.
    UtcTime end;       ///< Time of the last sample.

    bool operator==(const Mark&) const = default;
};

/// Returns the mark of a record of the archive; std::nullopt if the bytes are none.
[[nodiscard]] std::optional<Mark> mark_of(std::span<const std::byte> bytes);

/// Returns true if a record was sent before, or with, the last one that was sent.
///
/// Its sequence number is not later, and it begins before the end of the last one.  The second
/// condition matters if the last one is not in the archive: after a power cut that cost records
/// already sent, and in a new archive, their numbers are used again for later samples.
/// @param is_last_archived  the last one is in the archive.  Then the number decides alone on the two
///     days after it, because the host's clock may have been set back over midnight.
[[nodiscard]] bool is_sent(const Mark& record, const Mark& last, bool is_last_archived);

/// Record of the archive, as it is in its day file.
struct Record {
    std::string stream;  ///< Name of the stream.
    std::array<std::byte, archive::kRecordSize> bytes{};
    Mark mark;
    std::uint64_t end = 0;  ///< Offset after it in its day file.
};

/// Streams of an archive.  A stream is one channel of one station, named NET_STA_LOC_CHAN.
/// Not thread-safe.
class ArchiveStreams {
public:
    /// @param archive  root of the archive; it may be missing.
    explicit ArchiveStreams(std::filesystem::path archive) : archive_(std::move(archive)) {}

    /// Looks for new streams, days and records.  All directories are read with the first call and
    /// at most every 5 s; other calls examine known files and the next day of each stream.
    /// @throws std::system_error  a directory cannot be read.
    void look(std::chrono::steady_clock::time_point now);

    /// Returns the streams that have no position yet, sorted.
    [[nodiscard]] std::vector<std::string> unplaced() const;

    /// Sets where a stream begins: after the record sent last, or with the first record that ends
    /// at `from` or later.
    /// @throws std::system_error  a day file cannot be read.
    void place(const std::string& stream, std::optional<Mark> last, UtcTime from);

    /// Takes the next record of all placed streams: that of the earliest end.  The records of a
    /// stream come in the order in which they were written.
    /// @return std::nullopt if no complete record is left; call look() later.
    /// @throws std::system_error  a day file cannot be read.
    [[nodiscard]] std::optional<Record> next();

    /// Sends nothing of a stream.
    void leave_out(const std::string& stream);

    /// Returns the damage that was skipped since the last call: also records of another station or
    /// channel, and blocks that the disk cannot read.
    [[nodiscard]] std::vector<archive::Damage> take_damage();

    /// Returns the day files that grew since the last call, although they are more than two days
    /// older than the last record taken.  Their new records are not sent.
    [[nodiscard]] std::vector<std::filesystem::path> take_too_old();

private:
    struct DayFile {
        std::uint64_t size = 0;     ///< Size when it was examined last.
        std::uint64_t read_to = 0;  ///< Offset after the records in `ahead`.
        std::deque<Record> ahead;   ///< Records that were read and not taken.
    };
    struct Stream {
        std::filesystem::path stem;  ///< Day file without year and day.
        journal::StationCodes codes;
        std::string channel;
        bool is_placed = false;
        std::optional<Mark> last;  ///< Record taken last.
        bool is_last_archived = false;
        UtcTime from;              ///< Used without `last`.
        std::chrono::sys_days first_day = std::chrono::sys_days::min();
        std::map<std::chrono::sys_days, DayFile> days;          ///< From `first_day` on.
        std::map<std::chrono::sys_days, std::uint64_t> passed;  ///< Sizes of older day files.
    };
    void list();
    static void begin_at(Stream& stream, UtcTime time);
    void examine(Stream& stream) const;
    [[nodiscard]] std::filesystem::path file_of(const std::filesystem::path& stem,
                                                std::chrono::sys_days day) const;
    [[nodiscard]] bool fill(const std::string& name, Stream& stream, std::chrono::sys_days day);
    [[nodiscard]] DayFile* day_of_next(const std::string& name, Stream& stream);

    std::filesystem::path archive_;
    std::map<std::string, Stream, std::less<>> streams_;
    std::optional<std::chrono::steady_clock::time_point> listed_;
    std::vector<archive::Damage> damage_;
    std::vector<std::filesystem::path> too_old_;
};

}  // namespace a351::daemon::stream
