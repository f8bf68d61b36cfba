#pragma once
/// @file
/// The SDS archive as files: `YEAR/NET/STA/CHAN.D/NET.STA.LOC.CHAN.D.YEAR.DAY`.  Only whole records
/// are appended; a day file is created with its first one.

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

namespace a351::record {

/// Returns the day file for a record that starts at `start` (UTC day of its first sample).
[[nodiscard]] std::filesystem::path sds_file(const std::filesystem::path& archive,
                                             const StationCodes& codes, const std::string& channel,
                                             UtcTime start);

/// Returns the channels that have a directory for a station in any year, sorted.
[[nodiscard]] std::vector<std::string> channels_in(const std::filesystem::path& archive,
                                                   const StationCodes& codes);

/// Returns the day files of a channel, sorted by day, without side files such as `*.torn`.
[[nodiscard]] std::vector<std::filesystem::path> day_files(const std::filesystem::path& archive,
                                                           const StationCodes& codes,
                                                           const std::string& channel);

/// Returns the newest day file of a channel, if there is one.
[[nodiscard]] std::optional<std::filesystem::path> newest_day_file(
    const std::filesystem::path& archive, const StationCodes& codes, const std::string& channel);

/// Bytes that a crash left after the last whole record.
struct TornTail {
    std::filesystem::path file;
    std::uint64_t offset = 0;
    std::uint64_t byte_count = 0;
};

/// Moves the bytes after the last whole record to `DAYFILE.OFFSET.torn` beside the day file, and
/// removes a day file that is or becomes empty.
/// @param synced_until  given after a power failure.  After the records that begin until then, any
///                      page may be missing; so the first bytes that are not a record are cut, with
///                      everything after them.
/// @return the part that was cut, if any.
std::optional<TornTail> repair_tail(FileLayer& files, const std::filesystem::path& day_file,
                                    std::optional<UtcTime> synced_until = std::nullopt);

/// Appends records to day files and keeps one file open per channel.  A day file is created with
/// its first record; a torn tail is cut before the first append; a day file is synced when its day
/// ends.
/// @throws std::system_error  append: nothing of the record was written, it can be appended again.
///         sync, or the sync of the day before within append: unsynced data may be lost, and every
///         later sync() throws.
class SdsWriter {
public:
    SdsWriter(FileLayer& files, std::filesystem::path archive, StationCodes codes);

    void append(const std::string& channel, const PackedRecord& record);
    void sync();  ///< Syncs every file changed since the last call.

private:
    struct Open {
        std::filesystem::path path;
        std::unique_ptr<AppendFile> file;
        bool is_dirty = false;
    };
    void close(const std::string& channel);

    FileLayer& files_;
    std::filesystem::path archive_;
    StationCodes codes_;
    std::map<std::string, Open> open_;
    std::set<std::filesystem::path> new_entries_;  ///< Directories that must be synced.
    bool may_have_lost_ = false;
};

}  // namespace a351::record
