#pragma once
/// @file
/// The SDS archive as files: `YEAR/NET/STA/CHAN.D/NET.STA.LOC.CHAN.D.YEAR.DAY`.  Only whole records
/// are appended; a day file comes into being with its first one.

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

/// The day file that holds a record starting at `start` (UTC day of its first sample).
[[nodiscard]] std::filesystem::path sds_file(const std::filesystem::path& archive,
                                             const StationCodes& codes, const std::string& channel,
                                             UtcTime start);

/// Channel directories present for a station, over all years, sorted by channel.
[[nodiscard]] std::vector<std::string> channels_in(const std::filesystem::path& archive,
                                                   const StationCodes& codes);

/// Day files of a channel by day; side files such as `*.torn` are none.
[[nodiscard]] std::vector<std::filesystem::path> day_files(const std::filesystem::path& archive,
                                                           const StationCodes& codes,
                                                           const std::string& channel);

/// Newest day file of a channel, if there is one.
[[nodiscard]] std::optional<std::filesystem::path> newest_day_file(
    const std::filesystem::path& archive, const StationCodes& codes, const std::string& channel);

/// What a crash left behind the last whole record.
struct TornTail {
    std::filesystem::path file;
    std::uint64_t offset = 0;
    std::uint64_t byte_count = 0;
};

/// Cuts what follows the last whole record into `DAYFILE.OFFSET.torn` beside the archive's day file,
/// and removes a file that becomes or is empty.
/// @param synced_until  after a power cut: behind the records that begin until then any page may be
///                      missing, so the first that is no record is cut too, with all behind it.
/// @return what was cut, if anything.
std::optional<TornTail> repair_tail(FileLayer& files, const std::filesystem::path& day_file,
                                    std::optional<UtcTime> synced_until = std::nullopt);

/// Appends records to day files, keeping one file open per channel.  The first record of a day file
/// comes into being with it; a torn tail is cut before the first append; the day before is synced
/// at its end.
/// @throws std::system_error  append: nothing of the record is there, it can be appended again.
///         sync, or the sync of the day before within append: what was not synced may be lost, and
///         every later sync() throws.
class SdsWriter {
public:
    SdsWriter(FileLayer& files, std::filesystem::path archive, StationCodes codes);

    void append(const std::string& channel, const PackedRecord& record);
    void sync();  ///< Every file touched since the last call.

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
    std::set<std::filesystem::path> new_entries_;  ///< Directories to be synced.
    bool may_have_lost_ = false;
};

}  // namespace a351::record
