#pragma once
/// @file
/// The SDS archive as files: `YEAR/NET/STA/CHAN.D/NET.STA.LOC.CHAN.D.YEAR.DAY`.  Only whole records
/// are appended; a day file is created with its first one.
///
/// The functions find and repair files; SdsWriter appends to them.  Writer adds sequence
/// numbers, read_channel() reads samples.  The codes become parts of paths, so codes from outside
/// must be checked with are_valid() before.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "protocol/archive/miniseed.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::archive {

/// Returns the day file for a record that starts at `start` (UTC day of its first sample).
///
/// The file need not exist.  DAY has three digits, 001 to 366.  If the location is empty, its dots
/// remain.
[[nodiscard]] std::filesystem::path sds_file(const std::filesystem::path& archive,
                                             const journal::StationCodes& codes,
                                             const std::string& channel, UtcTime start);

/// Returns the channels that have a directory for a station in any year, sorted.  Empty if the
/// archive does not exist.  A channel may have a directory without a file.
/// @throws std::filesystem::filesystem_error  a directory cannot be read.
[[nodiscard]] std::vector<std::string> channels_in(const std::filesystem::path& archive,
                                                   const journal::StationCodes& codes);

/// Returns the day files of a channel, sorted by day, without side files such as `*.torn`.  Empty
/// if there are none; files of other locations are left out.
/// @throws std::filesystem::filesystem_error  a directory cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> day_files(const std::filesystem::path& archive,
                                                           const journal::StationCodes& codes,
                                                           const std::string& channel);

/// Returns the day files of a channel for the days of the interval [from, to), sorted by day.
/// @param from, to  from < to; both may be outside the archive, for example UtcTime::min().
[[nodiscard]] std::vector<std::filesystem::path> day_files(const std::filesystem::path& archive,
                                                           const journal::StationCodes& codes,
                                                           const std::string& channel, UtcTime from,
                                                           UtcTime to);

/// Returns the day files of a channel in [from, to) that a tool has compressed, such as NAME.gz, and
/// that are not there uncompressed too, sorted by day.  They are not read.
[[nodiscard]] std::vector<std::filesystem::path> compressed_day_files(
    const std::filesystem::path& archive, const journal::StationCodes& codes,
    const std::string& channel, UtcTime from, UtcTime to);

/// Returns the begin of the day of a day file, by its name.
/// @param file  from day_files().
[[nodiscard]] UtcTime day_of(const std::filesystem::path& file);

/// Returns the day files of a channel to which records may have been added last: the three newest,
/// sorted by day.  After the host's clock was set back over midnight an older day continues; a clock
/// set back by more than two days is not covered.
[[nodiscard]] std::vector<std::filesystem::path> recent_day_files(
    const std::filesystem::path& archive, const journal::StationCodes& codes,
    const std::string& channel);

/// Returns the newest day file of a channel, if there is one.  Newest is the latest day in the
/// name, not the time of the last change.
[[nodiscard]] std::optional<std::filesystem::path> newest_day_file(
    const std::filesystem::path& archive, const journal::StationCodes& codes,
    const std::string& channel);

/// Returns the folder for side files, `state` of the data root: other programs take every file
/// below the archive for data.
[[nodiscard]] std::filesystem::path side_directory(const std::filesystem::path& archive);

/// Bytes that a crash left after the last whole record.
struct TornTail {
    std::filesystem::path file;    ///< Day file that was cut.
    std::uint64_t offset = 0;      ///< First byte cut: the size now; the file is removed at 0.
    std::uint64_t byte_count = 0;  ///< Bytes that were cut; 0 for an empty file that was removed.
};

/// Moves the bytes after the last whole record to `DAYFILE.OFFSET.torn` in the side directory, and
/// removes a day file that is or becomes empty.
///
/// After a cut the rest of the file is synced.  Without `synced_until` only the end of the file is
/// read.
/// @param day_file      must exist; a writer that has it open must reopen it before it appends.
/// @param side          side_directory(); it is created when needed.
/// @param synced_until  given after a power failure.  After the records that begin until then, any
///                      page may be missing; so the first bytes that are not a record are cut, with
///                      everything after them.
/// @return the part that was cut, if any.
/// @throws std::system_error  the file cannot be read or changed; call it again.  Nothing is copied
///                            through a link in place of the file.
std::optional<TornTail> repair_tail(files::FileLayer& files, const std::filesystem::path& day_file,
                                    const std::filesystem::path& side,
                                    std::optional<UtcTime> synced_until = std::nullopt);

/// Appends records to day files and keeps one file open per channel.  A day file is created with
/// its first record; a torn tail is cut before the first append; a day file is synced when its day
/// ends.
///
/// Only one writer at a time may write to the archive of a station.  Not thread-safe.  The
/// destructor does not sync.
/// @throws std::system_error  append: nothing of the record was written, it can be appended again.
///         sync, or the sync of the day before within append: unsynced data may be lost, and every
///         later sync() throws.
class SdsWriter {
public:
    /// Opens and creates nothing yet.  `files` must outlive this.
    SdsWriter(files::FileLayer& files, std::filesystem::path archive, journal::StationCodes codes);

    /// Appends a record to the day file of its start time.  It survives a crash of the program at
    /// once, but a power cut only after the next sync().
    /// @param channel  names the file; it is not compared with the header of the record.
    void append(const std::string& channel, const PackedRecord& record);
    void sync();  ///< Syncs every file changed since the last call.

private:
    struct Open {
        std::filesystem::path path;
        std::unique_ptr<files::AppendFile> file;
        bool is_dirty = false;
    };
    void create(const std::filesystem::path& day_file, const PackedRecord& record);
    void close(const std::string& channel);

    files::FileLayer& files_;
    std::filesystem::path archive_;
    journal::StationCodes codes_;
    std::map<std::string, Open> open_;
    std::set<std::filesystem::path> new_entries_;  ///< Directories that must be synced.
    bool may_have_lost_ = false;
};

}  // namespace a351::archive
