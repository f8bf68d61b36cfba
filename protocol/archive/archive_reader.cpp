#include "protocol/archive/archive_reader.hpp"

#include <fmt/core.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "protocol/archive/record_file.hpp"
#include "protocol/archive/record_joiner.hpp"
#include "protocol/archive/sds.hpp"

namespace a351::archive {

namespace {

namespace fs = std::filesystem;

/// Returns true if a record continues the last segment: same rate, start within half a sample.
bool continues(const ChannelData& data, UtcTime start, double rate_hz) {
    if (data.segments.empty() || data.segments.back().rate_hz != rate_hz) return false;
    const Segment& last = data.segments.back();
    return std::chrono::abs(start - last.time_of(last.counts.size())) <=
           from_seconds(0.5 / rate_hz);
}

/// Reserves space, and asks the system for large pages; with small ones it is only slower.  With
/// what a351-correct does about freed memory, a survey day makes 6 700 page faults instead of
/// 13 400, a week 29 500 instead of 46 300.  Where a fault costs 13 us (a virtual machine), they
/// need 0.76 to 0.89 of the processor's time.
void reserve_in_large_pages(std::vector<std::int32_t>& counts, std::size_t size) {
    constexpr std::size_t kLargePage = 2 << 20;  // bytes, on amd64
    counts.reserve(size);
    if (counts.capacity() * sizeof(std::int32_t) < kLargePage) return;
    static const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    const auto begin = reinterpret_cast<std::uintptr_t>(counts.data()) / page * page;
    const auto end = reinterpret_cast<std::uintptr_t>(counts.data() + counts.capacity());
    ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

/// The records of a day file so far, to find those that are there twice.
class RecordsSeen {
public:
    explicit RecordsSeen(RecordFile& file) : file_(file) {}

    /// Returns false if the record at `offset` was seen before, maybe with another number.
    [[nodiscard]] bool is_new(UtcTime start, std::uint64_t offset) {
        constexpr std::size_t kNumber = 6;  // digits of the record's number, which begin it
        const auto body = [this](std::uint64_t record) {
            return file_.bytes(record + kNumber, kRecordSize - kNumber);
        };
        // In a file of one recorder the times ascend, and nothing is compared.
        auto at = std::ranges::lower_bound(seen_, start, {}, &Seen::start);
        for (; at != seen_.end() && at->start == start; ++at)
            if (body(at->offset) == body(offset)) return false;
        seen_.insert(at, {start, offset});
        return true;
    }

private:
    struct Seen {
        UtcTime start;
        std::uint64_t offset = 0;
    };
    RecordFile& file_;
    std::vector<Seen> seen_;  ///< Ascending.
};

/// Returns true if two rates are one, within 0.1 %.  Reason: the clock of a sensor is within 0.02 %,
/// and rates that other programs wrote wrong differ by 2 % (49 for 50 Hz).
bool is_same_rate(double one_hz, double other_hz) {
    return std::abs(one_hz / other_hz - 1.0) <= 0.001;
}

/// Returns the conflict of the first rate that differs from the metadata, proven by the records that
/// have it; absent if there is none, or if there are not two such records.
std::optional<RateConflict> rate_conflict(const std::vector<Segment>& segments,
                                          const std::string& channel, double metadata_hz) {
    const auto other = std::ranges::find_if(segments, [&](const Segment& segment) {
        return !is_same_rate(segment.rate_hz, metadata_hz);
    });
    if (other == segments.end()) return std::nullopt;
    RateConflict conflict{channel, other->rate_hz, metadata_hz};
    std::vector<double> rates_hz;
    std::size_t longest = 0, count = 0;
    const Segment::Anchor* before = nullptr;
    for (const Segment& segment : segments) {
        if (segment.rate_hz != other->rate_hz) {
            before = nullptr;
            continue;
        }
        for (std::size_t i = 0; i < segment.anchors.size(); ++i) {
            const Segment::Anchor& anchor = segment.anchors[i];
            if (before != nullptr && before->time < anchor.time)
                rates_hz.push_back(static_cast<double>(count) /
                                   seconds_between(before->time, anchor.time));
            before = &anchor;
            count = (i + 1 < segment.anchors.size() ? segment.anchors[i + 1].offset
                                                    : segment.counts.size()) -
                    anchor.offset;
            longest = std::max(longest, count);
        }
    }
    if (rates_hz.empty()) return std::nullopt;
    const auto median = rates_hz.begin() + static_cast<std::ptrdiff_t>(rates_hz.size() / 2);
    std::ranges::nth_element(rates_hz, median);
    conflict.observed_hz = *median;
    conflict.used_hz = is_same_rate(*median, metadata_hz) ? metadata_hz : conflict.header_hz;
    conflict.longest_s = static_cast<double>(longest) / *median;
    return conflict;
}

}  // namespace

bool is_of(const journal::StationCodes& codes, const RecordHeader& header) {
    return header.network == codes.network && header.station == codes.station &&
           header.location == codes.location;
}

void RecordJoiner::take(const DecodedRecord& record) {
    const bool is_wrong = wrong_ && record.rate_hz() == wrong_->header_hz;
    const double rate_hz = is_wrong ? wrong_->used_hz : record.rate_hz();
    const UtcTime start = record.header.start;
    const auto time_of = [&](std::size_t i) {
        return start + from_seconds(static_cast<double>(i) / rate_hz);
    };
    const std::size_t count = record.samples.size();
    std::size_t first = 0;
    while (first < count && time_of(first) < from_) ++first;
    std::size_t last = count;
    while (last > first && time_of(last - 1) >= to_) --last;
    if (first == last) return;
    if (!continues(data_, start, rate_hz))
        data_.segments.push_back({rate_hz, std::exchange(memory_, {}), {}});
    Segment& segment = data_.segments.back();
    segment.anchors.push_back({segment.counts.size(), time_of(first),
                               record.header.is_time_questionable,
                               record.header.timing_quality_percent});
    // At least twice as much as before, so that a segment of many days is not copied every day.
    if (const std::size_t needed = segment.counts.size() + std::exchange(expected_, 0) * count;
        needed > segment.counts.capacity())
        reserve_in_large_pages(segment.counts, std::max(needed, 2 * segment.counts.capacity()));
    segment.counts.insert(segment.counts.end(),
                          record.samples.begin() + static_cast<std::ptrdiff_t>(first),
                          record.samples.begin() + static_cast<std::ptrdiff_t>(last));
}

UtcTime Segment::time_of(std::size_t i) const {
    const auto after = std::ranges::upper_bound(anchors, i, {}, &Anchor::offset);
    assert(after != anchors.begin());
    const Anchor& anchor = *std::prev(after);
    return anchor.time + from_seconds(static_cast<double>(i - anchor.offset) / rate_hz);
}

std::string to_text(const Damage& damage) {
    return fmt::format(
        "{}: offset {}: {} bytes are {}", damage.file.filename().string(), damage.offset,
        damage.byte_count,
        damage.is_of_another_station ? "a record of another station" : "not a record");
}

namespace {

/// Reads the records of a channel.
/// @param wrong, memory  for RecordJoiner.
ChannelData read_records(const fs::path& archive, const journal::StationCodes& codes,
                         const std::string& channel, UtcTime from, UtcTime to,
                         const std::optional<RateConflict>& wrong,
                         std::vector<std::int32_t> memory = {}) {
    ChannelData data;
    if (from >= to) return data;
    RecordJoiner joiner(data, from, to, wrong, std::move(memory));
    const auto files = day_files(archive, codes, channel, from, to);
    for (auto file = files.begin(); file != files.end(); ++file) {  // no record crosses midnight
        RecordFile records(*file, channel);
        RecordsSeen seen(records);
        const auto next = std::next(file);  // a survey day can pass midnight UTC
        const std::uintmax_t to_come = next == files.end() ? 0 : fs::file_size(*next);
        joiner.expect((records.size() + to_come) / kRecordSize);
        while (true) {
            const auto found = records.next();
            if (records.skipped() > 0)
                data.damage.push_back({*file, records.skipped_at(), records.skipped()});
            if (!found) break;
            const auto& [offset, record] = *found;
            if (!is_of(codes, record.header))
                data.damage.push_back({*file, offset, kRecordSize, true});
            else if (seen.is_new(record.header.start, offset))
                joiner.take(record);
        }
    }
    std::ranges::stable_sort(data.segments, {},
                             [](const Segment& one) { return one.anchors.front().time; });
    return data;
}

}  // namespace

ChannelData read_channel(const fs::path& archive, const journal::StationCodes& codes,
                         const std::string& channel, UtcTime from, UtcTime to,
                         std::optional<double> metadata_hz, std::vector<std::int32_t> memory) {
    ChannelData data = read_records(archive, codes, channel, from, to, {}, std::move(memory));
    if (!metadata_hz) return data;
    const auto conflict = rate_conflict(data.segments, channel, *metadata_hz);
    if (conflict && conflict->used_hz == *metadata_hz)
        data = read_records(archive, codes, channel, from, to, conflict);
    data.rate_conflict = conflict;
    return data;
}

std::vector<AbsentFile> absent_day_files(const fs::path& archive,
                                         const journal::StationCodes& codes,
                                         const std::vector<std::string>& channels, UtcTime from,
                                         UtcTime to) {
    std::map<UtcTime, std::set<std::string>> present;
    for (const std::string& channel : channels)
        for (const auto& file : day_files(archive, codes, channel, from, to))
            present[day_of(file)].insert(channel);
    std::vector<AbsentFile> absent;
    for (const std::string& channel : channels) {
        for (const auto& file : compressed_day_files(archive, codes, channel, from, to)) {
            const UtcTime day = day_of(file.parent_path() / file.stem());
            present[day].insert(channel);
            absent.push_back({channel, day, file});
        }
    }
    for (const auto& [day, there] : present) {
        const auto is_long = [&, from_day = day](const std::string& channel) {
            const auto data =
                read_channel(archive, codes, channel, from_day, from_day + std::chrono::days(1));
            if (data.segments.empty()) return false;
            const Segment& last = data.segments.back();
            return last.time_of(last.counts.size()) - data.segments.front().time_of(0) >=
                   2 * journal::kLongestRecordAge;
        };
        if (there.size() == channels.size() || std::ranges::none_of(there, is_long)) continue;
        for (const std::string& channel : channels)
            if (!there.contains(channel)) absent.push_back({channel, day});
    }
    std::ranges::stable_sort(absent, {}, &AbsentFile::day);
    return absent;
}

}  // namespace a351::archive
