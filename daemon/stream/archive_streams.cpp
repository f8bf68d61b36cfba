#include "daemon/stream/archive_streams.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <system_error>
#include <utility>

#include "protocol/archive/archive_writer.hpp"
#include "protocol/files/file_bytes.hpp"
#include "protocol/files/file_layer.hpp"

namespace a351::daemon::stream {
namespace {

namespace fs = std::filesystem;
using archive::kRecordSize;
using std::chrono::days;
using std::chrono::sys_days;

/// A clock set back over midnight continues an older day; see archive::recent_day_files().
constexpr days kSetBack{2};
/// Records read at once: 32 KiB, so that ten streams need little memory.
constexpr std::uint64_t kRecordsAhead = 64;
/// Page of the kernel: it reads at least so much at once, so an unreadable sector costs that.
constexpr std::uint64_t kPage = 4096;
constexpr std::chrono::seconds kBetweenLists{5};

struct DayName {
    journal::StationCodes codes;
    std::string channel;
    sys_days day;
};

bool is_code_character(char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

/// Reads the name of a day file: NET.STA.LOC.CHAN.D.YEAR.DAY.
std::optional<DayName> parse_day_name(const std::string& name) {
    std::vector<std::string> parts(1);
    for (const char c : name) {
        if (c == '.')
            parts.emplace_back();
        else
            parts.back() += c;
    }
    if (parts.size() != 7 || parts[4] != "D" || !files::has_shape(parts[5], "####") ||
        !files::has_shape(parts[6], "###") || parts[3].size() != 3 ||
        !std::ranges::all_of(parts[3], is_code_character))
        return std::nullopt;
    DayName day{.codes = {.network = parts[0], .station = parts[1], .location = parts[2]},
                .channel = parts[3],
                .day = sys_days(std::chrono::year(std::stoi(parts[5])) / 1 / 1) +
                       days(std::stoi(parts[6]) - 1)};
    if (!are_valid(day.codes)) return std::nullopt;
    return day;
}

std::uint64_t size_of(const fs::path& file) {
    std::error_code error;
    const auto size = fs::file_size(file, error);
    return error ? 0 : size;  // A day file that a repair removed has no records.
}

/// Reads bytes of a day file; none if the disk cannot read them all.
std::vector<std::byte> readable(const fs::path& file, std::uint64_t offset, std::uint64_t count) {
    try {
        return files::read_bytes(file, offset, count);
    } catch (const std::system_error&) {
        if (size_of(file) < offset + count) throw;         // It was cut meanwhile.
        static_cast<void>(files::read_bytes(file, 0, 0));  // Throws if it cannot be opened.
        return {};
    }
}

/// Returns the offset after a record in a day file, which is read from its end; 0 if the record is
/// not there.
std::uint64_t offset_behind(const fs::path& file, std::uint64_t size, const Mark& mark) {
    const std::string digits = fmt::format("{:06}", mark.sequence);
    for (std::uint64_t end = size / kRecordSize; end > 0;) {
        const std::uint64_t begin = (end - 1) / kRecordsAhead * kRecordsAhead;
        const auto bytes = readable(file, begin * kRecordSize, (end - begin) * kRecordSize);
        if (bytes.empty()) end = begin;
        for (; end > begin; --end) {
            const auto record =
                std::span(bytes).subspan((end - 1 - begin) * kRecordSize, kRecordSize);
            if (std::memcmp(record.data(), digits.data(), digits.size()) != 0) continue;
            const auto found = mark_of(record);
            if (found && found->start == mark.start) return end * kRecordSize;
        }
    }
    return 0;
}

/// Returns true if the last whole record of a day file was sent before, or with, `last`.
bool ends_sent(const fs::path& file, std::uint64_t size, const Mark& last) {
    if (size < kRecordSize) return false;
    const auto bytes = readable(file, (size / kRecordSize - 1) * kRecordSize, kRecordSize);
    const auto mark = mark_of(bytes);
    return mark && is_sent(*mark, last, true);
}

}  // namespace

std::optional<Mark> mark_of(std::span<const std::byte> bytes) {
    const auto record = archive::decode_record(bytes);
    if (!record) return std::nullopt;
    return Mark{record->header.sequence, record->header.start, record->last_sample()};
}

bool is_sent(const Mark& record, const Mark& last, bool is_last_archived) {
    if (record.sequence != last.sequence && !archive::precedes(record.sequence, last.sequence))
        return false;
    if (record.start <= last.end) return true;
    const days later = floor<days>(record.start) - floor<days>(last.start);
    return is_last_archived && later > days(0) && later <= kSetBack;
}

/// @param stem  NET/STA/CHAN.D/NET.STA.LOC.CHAN.D
fs::path ArchiveStreams::file_of(const fs::path& stem, sys_days day) const {
    const std::chrono::year year = std::chrono::year_month_day(day).year();
    return archive_ / fmt::format("{:04}", static_cast<int>(year)) / stem.parent_path() /
           fmt::format("{}.{:04}.{:03}", stem.filename().string(), static_cast<int>(year),
                       (day - sys_days(year / 1 / 1)).count() + 1);
}

void ArchiveStreams::list() {
    if (!fs::is_directory(archive_)) return;
    for (const auto& entry : fs::recursive_directory_iterator(archive_)) {
        const auto name = parse_day_name(entry.path().filename().string());
        if (!name) continue;
        const auto& [codes, channel, day] = *name;
        const fs::path stem =
            fs::path(codes.network) / codes.station / (channel + ".D") /
            fmt::format("{}.{}.{}.{}.D", codes.network, codes.station, codes.location, channel);
        if (entry.path() != file_of(stem, day)) continue;  // A copy elsewhere, or no day of a year.
        Stream& stream = streams_[fmt::format("{}_{}_{}_{}", codes.network, codes.station,
                                              codes.location, channel)];
        stream.codes = codes;
        stream.channel = channel;
        stream.stem = stem;
        if (day >= stream.first_day) {
            stream.days.try_emplace(day);
            continue;
        }
        const std::uint64_t size = size_of(entry.path());
        std::uint64_t& passed = stream.passed[day];
        if (size > passed && stream.last) too_old_.push_back(entry.path());
        passed = size;
    }
}

void ArchiveStreams::begin_at(Stream& stream, UtcTime time) {
    stream.first_day = floor<days>(time) - kSetBack;
    const auto first = stream.days.lower_bound(stream.first_day);
    for (auto it = stream.days.begin(); it != first; ++it)
        stream.passed[it->first] = it->second.size;
    stream.days.erase(stream.days.begin(), first);
}

/// Finds the sizes of the day files.  A day file that became shorter was repaired: what is appended
/// then may have been sent before the repair, which is_sent() tells.
void ArchiveStreams::examine(Stream& stream) const {
    if (stream.days.empty()) return;
    stream.days.try_emplace(stream.days.rbegin()->first + days(1));
    for (auto& [day, file] : stream.days) {
        file.size = size_of(file_of(stream.stem, day));
        if (file.size >= file.read_to) continue;
        while (!file.ahead.empty() && file.ahead.back().end > file.size) file.ahead.pop_back();
        file.read_to = file.size;
        stream.is_last_archived = false;  // It may be among the records that were cut off.
    }
    if (stream.last) begin_at(stream, stream.last->start);
    while (stream.days.size() > 1 && stream.days.rbegin()->second.size == 0)
        stream.days.erase(std::prev(stream.days.end()));
}

void ArchiveStreams::look(std::chrono::steady_clock::time_point now) {
    if (!listed_ || now - *listed_ >= kBetweenLists) {
        list();
        listed_ = now;
    }
    for (auto& [name, stream] : streams_) examine(stream);
}

std::vector<std::string> ArchiveStreams::unplaced() const {
    std::vector<std::string> names;
    for (const auto& [name, stream] : streams_)
        if (!stream.is_placed) names.push_back(name);
    return names;
}

void ArchiveStreams::place(const std::string& name, std::optional<Mark> last, UtcTime from) {
    Stream& stream = streams_.at(name);
    stream.is_placed = true;
    stream.last = last;
    stream.from = from;
    begin_at(stream, last ? last->start : from);
    if (!last) return;
    for (auto& [day, file] : stream.days) {
        const auto path = file_of(stream.stem, day);
        const days later = day - floor<days>(last->start);
        if (later == days(0)) {
            file.read_to = offset_behind(path, file.size, *last);
            stream.is_last_archived = file.read_to > 0;
        } else if (later < days(0) && ends_sent(path, file.size, *last)) {
            file.read_to = file.size / kRecordSize * kRecordSize;
        }
    }
}

/// Reads further records of a day file, if none is ahead.  Returns false if it has none.
bool ArchiveStreams::fill(const std::string& name, Stream& stream, sys_days day) {
    DayFile& file = stream.days.at(day);
    const auto is_old = [&](const Mark& mark) {
        return stream.last ? is_sent(mark, *stream.last, stream.is_last_archived)
                           : mark.end < stream.from;
    };
    while (true) {
        while (!file.ahead.empty() && is_old(file.ahead.front().mark)) file.ahead.pop_front();
        if (!file.ahead.empty()) return true;
        if (file.size < file.read_to + kRecordSize) return false;
        const std::uint64_t left = file.size - file.read_to;
        const auto path = file_of(stream.stem, day);
        const std::uint64_t to_page = kPage - file.read_to % kPage;
        auto bytes =
            readable(path, file.read_to, std::min(left / kRecordSize, kRecordsAhead) * kRecordSize);
        if (bytes.empty() && to_page >= kRecordSize)
            bytes =
                readable(path, file.read_to, std::min(left, to_page) / kRecordSize * kRecordSize);
        if (bytes.empty()) {
            damage_.push_back({path, file.read_to, std::min(left, to_page)});
            file.read_to += std::min(left, to_page);
            continue;
        }
        const std::uint64_t count = bytes.size();
        std::size_t begin = 0;
        for (const auto& [start, found] : archive::find_records(bytes, stream.channel)) {
            if (start > begin) damage_.push_back({path, file.read_to + begin, start - begin});
            begin = start + kRecordSize;
            Record record{name,
                          {},
                          {found.header.sequence, found.header.start, found.last_sample()},
                          file.read_to + begin};
            if (const auto& codes = stream.codes; found.header.network != codes.network ||
                                                  found.header.station != codes.station ||
                                                  found.header.location != codes.location) {
                damage_.push_back({path, file.read_to + start, kRecordSize, true});
                continue;
            }
            std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(start), kRecordSize,
                        record.bytes.begin());
            file.ahead.push_back(std::move(record));
        }
        if (begin == 0 && count == left / kRecordSize * kRecordSize)
            return false;  // The end of the file is damaged: the daemon repairs it at its start.
        if (begin == 0) {
            begin = count - kRecordSize + 1;  // A record may begin in the last bytes.
            damage_.push_back({path, file.read_to, begin});
        }
        file.read_to += begin;
    }
}

/// Returns the day with the next record.  That is the oldest one, unless a newer day has the next
/// sequence number.
ArchiveStreams::DayFile* ArchiveStreams::day_of_next(const std::string& name, Stream& stream) {
    DayFile* oldest = nullptr;
    sys_days first;
    for (auto& [day, file] : stream.days) {
        if (oldest && day - first > kSetBack) break;
        if (!fill(name, stream, day)) continue;
        const int sequence = file.ahead.front().mark.sequence;
        if (!stream.last || sequence == stream.last->sequence % archive::kLargestSequence + 1)
            return &file;
        if (!oldest) {
            oldest = &file;
            first = day;
        }
    }
    return oldest;
}

std::optional<Record> ArchiveStreams::next() {
    DayFile* earliest = nullptr;
    Stream* owner = nullptr;
    for (auto& [name, stream] : streams_) {
        if (!stream.is_placed) continue;
        DayFile* const file = day_of_next(name, stream);
        if (!file) continue;
        if (earliest && earliest->ahead.front().mark.end <= file->ahead.front().mark.end) continue;
        earliest = file;
        owner = &stream;
    }
    if (!earliest) return std::nullopt;
    Record record = std::move(earliest->ahead.front());
    earliest->ahead.pop_front();
    owner->last = record.mark;
    owner->is_last_archived = true;
    return record;
}

void ArchiveStreams::leave_out(const std::string& name) {
    Stream& stream = streams_.at(name);
    stream.is_placed = true;
    stream.first_day = sys_days::max();
    stream.days.clear();
}

std::vector<archive::Damage> ArchiveStreams::take_damage() { return std::exchange(damage_, {}); }

std::vector<fs::path> ArchiveStreams::take_too_old() { return std::exchange(too_old_, {}); }

}  // namespace a351::daemon::stream
