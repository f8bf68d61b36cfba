#include "protocol/archive/sds.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <system_error>
#include <utility>

#include "protocol/files/file_bytes.hpp"

namespace a351::archive {

namespace {

namespace fs = std::filesystem;

/// Returns the file name up to the year: `NET.STA.LOC.CHAN.D.`
std::string name_stem(const journal::StationCodes& codes, const std::string& channel) {
    return fmt::format("{}.{}.{}.{}.D.", codes.network, codes.station, codes.location, channel);
}

/// Returns the directories of the station, one per year, ascending.
std::vector<fs::path> station_directories(const fs::path& archive,
                                          const journal::StationCodes& codes) {
    std::vector<fs::path> directories;
    if (!fs::is_directory(archive)) return directories;
    for (const auto& year : fs::directory_iterator(archive)) {
        const auto station = year.path() / codes.network / codes.station;
        if (files::has_shape(year.path().filename().string(), "####") && fs::is_directory(station))
            directories.push_back(station);
    }
    std::ranges::sort(directories);
    return directories;
}

}  // namespace

fs::path sds_file(const fs::path& archive, const journal::StationCodes& codes,
                  const std::string& channel, UtcTime start) {
    const auto day = std::chrono::floor<std::chrono::days>(start);
    const std::chrono::year_month_day date(day);
    const std::chrono::sys_days new_year = date.year() / std::chrono::January / 1;
    const std::string year = fmt::format("{:04}", static_cast<int>(date.year()));
    return archive / year / codes.network / codes.station / (channel + ".D") /
           fmt::format("{}{}.{:03}", name_stem(codes, channel), year, (day - new_year).count() + 1);
}

std::vector<std::string> channels_in(const fs::path& archive, const journal::StationCodes& codes) {
    std::set<std::string> channels;
    for (const auto& station : station_directories(archive, codes)) {
        for (const auto& entry : fs::directory_iterator(station)) {
            const auto& name = entry.path().filename();
            if (name.extension() == ".D") channels.insert(name.stem().string());
        }
    }
    return {channels.begin(), channels.end()};
}

namespace {

/// Returns the files of a channel that are named as a day file and `ending`.
std::vector<fs::path> files_ending(const fs::path& archive, const journal::StationCodes& codes,
                                   const std::string& channel, const std::string& ending) {
    const std::string stem = name_stem(codes, channel);
    std::vector<fs::path> files;
    for (const auto& station : station_directories(archive, codes)) {
        const auto directory = station / (channel + ".D");
        if (!fs::is_directory(directory)) continue;
        for (const auto& entry : fs::directory_iterator(directory)) {
            const std::string name = entry.path().filename().string();
            if (name.starts_with(stem) &&
                files::has_shape(std::string_view(name).substr(stem.size()), "####.###" + ending))
                files.push_back(entry.path());
        }
    }
    std::ranges::sort(files);
    return files;
}

}  // namespace

std::vector<fs::path> day_files(const fs::path& archive, const journal::StationCodes& codes,
                                const std::string& channel) {
    return files_ending(archive, codes, channel, "");
}

std::vector<fs::path> compressed_day_files(const fs::path& archive,
                                           const journal::StationCodes& codes,
                                           const std::string& channel, UtcTime from, UtcTime to) {
    const auto first = sds_file(archive, codes, channel, from).filename();
    const auto last = sds_file(archive, codes, channel, to - Nanoseconds(1)).filename();
    std::vector<fs::path> files;
    for (const char* ending : {".gz", ".bz2", ".xz", ".zst", ".zip"}) {
        for (const fs::path& file : files_ending(archive, codes, channel, ending)) {
            const auto name = file.stem();
            if (name >= first && name <= last && !fs::exists(file.parent_path() / name))
                files.push_back(file);
        }
    }
    std::ranges::sort(files);
    return files;
}

std::vector<fs::path> day_files(const fs::path& archive, const journal::StationCodes& codes,
                                const std::string& channel, UtcTime from, UtcTime to) {
    // Names sort by day.
    const auto first = sds_file(archive, codes, channel, from).filename();
    const auto last = sds_file(archive, codes, channel, to - Nanoseconds(1)).filename();
    auto files = day_files(archive, codes, channel);
    std::erase_if(files, [&](const fs::path& file) {
        return file.filename() < first || file.filename() > last;
    });
    return files;
}

UtcTime day_of(const fs::path& file) {
    const std::string name = file.filename().string();  // ends with .YEAR.DAY in digits
    const char* const end = name.data() + name.size();
    int year = 0, day = 0;
    std::from_chars(end - 8, end - 4, year);
    std::from_chars(end - 3, end, day);
    return std::chrono::sys_days(std::chrono::year(year) / 1 / 1) + std::chrono::days(day - 1);
}

std::vector<fs::path> recent_day_files(const fs::path& archive, const journal::StationCodes& codes,
                                       const std::string& channel) {
    constexpr std::size_t kRecent = 3;
    auto files = day_files(archive, codes, channel);
    if (files.size() > kRecent) files.erase(files.begin(), files.end() - kRecent);
    return files;
}

std::optional<fs::path> newest_day_file(const fs::path& archive, const journal::StationCodes& codes,
                                        const std::string& channel) {
    const auto files = day_files(archive, codes, channel);
    return files.empty() ? std::nullopt : std::optional(files.back());
}

namespace {

/// Returns the end of the records that can be kept if the file was not cut by a power failure: the
/// last whole record.
std::uint64_t end_of_whole_records(const fs::path& day_file) {
    std::uint64_t whole = fs::file_size(day_file) / kRecordSize * kRecordSize;
    while (whole > 0 &&
           !decode_record(files::read_bytes(day_file, whole - kRecordSize, kRecordSize)))
        whole -= kRecordSize;
    return whole;
}

/// Returns the end of the records that can be kept after a power failure: the first damaged one
/// after those that were synced.  These end with the record whose last sample is at `synced_until`.
/// Without such a record they are those that begin until then; times alone do not tell, because they
/// repeat after a clock was set back.
std::uint64_t end_of_good_records(const fs::path& day_file, UtcTime synced_until) {
    const auto bytes = files::read_bytes(day_file);
    std::optional<std::uint64_t> spoilt, spoilt_after_newest;
    bool has_newest = false;
    std::uint64_t good = 0;
    for (; good + kRecordSize <= bytes.size(); good += kRecordSize) {
        const auto record = decode_record(std::span(bytes).subspan(good, kRecordSize));
        if (!record) {
            if (!spoilt) spoilt = good;
            if (!spoilt_after_newest) spoilt_after_newest = good;
            continue;
        }
        if (record->header.start <= synced_until) spoilt.reset();
        if (record->last_sample() == synced_until) {
            has_newest = true;
            spoilt_after_newest.reset();
        }
    }
    return (has_newest ? spoilt_after_newest : spoilt).value_or(good);
}

}  // namespace

fs::path side_directory(const fs::path& archive) { return archive.parent_path() / "state"; }

std::optional<TornTail> repair_tail(files::FileLayer& files, const fs::path& day_file,
                                    const fs::path& side, std::optional<UtcTime> synced_until) {
    const std::uint64_t size = fs::file_size(day_file);
    const std::uint64_t whole = synced_until ? end_of_good_records(day_file, *synced_until)
                                             : end_of_whole_records(day_file);
    if (whole == size && size > 0) return std::nullopt;
    TornTail tail{day_file, whole, size - whole};
    if (tail.byte_count > 0) {
        // Several crashes may happen in a day; the offset in the name keeps their files apart.
        static_cast<void>(files.open_append(day_file));  // Refuses a link in place of a folder.
        files.create_directories(side);
        files::replace_file(files,
                            side / fmt::format("{}.{}.torn", day_file.filename().string(), whole),
                            files::read_own_bytes(day_file, whole, tail.byte_count));
    }
    if (whole > 0) {
        files.truncate(day_file, whole);
    } else {
        files.remove(day_file);
        files.sync_directory(day_file.parent_path());
    }
    return tail;
}

SdsWriter::SdsWriter(files::FileLayer& files, fs::path archive, journal::StationCodes codes)
    : files_(files), archive_(std::move(archive)), codes_(std::move(codes)) {}

void SdsWriter::append(const std::string& channel, const PackedRecord& record) {
    const auto path = sds_file(archive_, codes_, channel, record.start);
    if (open_.contains(channel) && open_.at(channel).path != path) close(channel);
    if (!open_.contains(channel)) {
        if (fs::exists(path)) repair_tail(files_, path, side_directory(archive_));
        if (!fs::exists(path)) return create(path, record);
        open_[channel] = {path, files_.open_append(path), false};
    }
    Open& open = open_.at(channel);
    open.is_dirty = true;
    try {
        open.file->append(record.bytes);
    } catch (...) {
        close(channel);  // Its tail is checked again before the next append.
        throw;
    }
}

/// Creates a day file with its first record: readers fail on an empty day file.
void SdsWriter::create(const fs::path& day_file, const PackedRecord& record) {
    const fs::path side = side_directory(archive_);
    files_.create_directories(day_file.parent_path());
    files_.create_directories(side);
    const fs::path temporary = side / (day_file.filename().string() + ".tmp");
    try {
        files::write_file_atomically(files_, day_file, record.bytes, temporary);
    } catch (const std::system_error& error) {
        if (error.code() != std::errc::cross_device_link) throw;
        files_.remove(temporary);
        files::write_file_atomically(files_, day_file, record.bytes);  // archive/ is a mount point.
    }
    // The parent directories are synced too: a program that made them earlier may have been killed
    // before it synced them.
    for (auto directory = day_file.parent_path(); directory != archive_.parent_path();
         directory = directory.parent_path())
        new_entries_.insert(directory);
}

/// Closes a file; syncs it before, because this is not possible later.
void SdsWriter::close(const std::string& channel) {
    const auto node = open_.extract(channel);
    if (!node.mapped().is_dirty) return;
    try {
        node.mapped().file->sync();
    } catch (...) {
        may_have_lost_ = true;
        throw;
    }
}

void SdsWriter::sync() {
    if (may_have_lost_) {
        throw std::system_error(EIO, std::generic_category(),
                                "sync " + archive_.string() + ": an earlier sync failed");
    }
    may_have_lost_ = true;  // Until all syncs succeeded.
    for (const fs::path& directory : new_entries_) files_.sync_directory(directory);
    new_entries_.clear();
    for (auto& [channel, open] : open_) {
        if (open.is_dirty) open.file->sync();
        open.is_dirty = false;
    }
    may_have_lost_ = false;
}

}  // namespace a351::archive
