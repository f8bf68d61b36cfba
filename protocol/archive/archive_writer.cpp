#include "protocol/archive/archive_writer.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "protocol/archive/miniseed_layout.hpp"
#include "protocol/core/invariant.hpp"

namespace a351::archive {
namespace {

constexpr std::size_t kSequenceDigits = 6;

bool read_record(std::istream& in, std::array<std::byte, kRecordSize>& bytes) {
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return in.good();
}

std::ifstream open_day_file(const std::filesystem::path& day_file) {
    std::ifstream in(day_file, std::ios::binary);
    if (!in) throw std::system_error(errno, std::generic_category(), "open " + day_file.string());
    return in;
}

/// Returns a record that was made here, as a reader sees it.
DecodedRecord decode_own(const PackedRecord& record) {
    auto decoded = decode_record(record.bytes);
    require_invariant(decoded && decoded->samples.size() == record.sample_count,
                      "a record that was made is read with its samples");
    return *std::move(decoded);
}

/// Returns the sequence number of the last whole record; 0 if there is none.
int last_sequence(const std::filesystem::path& day_file) {
    const auto size = std::filesystem::file_size(day_file);
    if (size < kRecordSize) return 0;
    auto in = open_day_file(day_file);
    in.seekg(static_cast<std::streamoff>((size / kRecordSize - 1) * kRecordSize));
    std::array<char, kSequenceDigits> digits{};
    in.read(digits.data(), digits.size());
    int sequence = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), sequence);
    return sequence;
}

void stamp_sequence(PackedRecord& record, int sequence) {
    for (std::size_t digit = kSequenceDigits; digit-- > 0; sequence /= 10)
        record.bytes[kSequenceAt + digit] =
            std::byte(static_cast<unsigned char>('0' + sequence % 10));
}

}  // namespace

bool precedes(int sequence, int other) noexcept {
    const int ahead = (other - sequence + kLargestSequence) % kLargestSequence;
    return ahead > 0 && ahead <= kLargestSequence / 2;
}

Writer::Writer(files::FileLayer& files, std::filesystem::path archive, journal::StationCodes codes)
    : files_(files),
      archive_(std::move(archive)),
      codes_(std::move(codes)),
      sds_(std::make_unique<SdsWriter>(files_, archive_, codes_)) {}

Writer::ArchivedRecord Writer::describe(const DecodedRecord& record) {
    const std::string_view bytes(reinterpret_cast<const char*>(record.samples.data()),
                                 record.samples.size() * sizeof(std::int32_t));
    return {record.samples.size(),
            std::hash<std::string_view>()(bytes),
            record.last_sample() + from_seconds(0.5 / record.rate_hz()),
            {},
            0,
            record.header.sequence};
}

void Writer::end_replay() {
    settle();
    is_replaying_ = false;
    for (auto& [name, channel] : channels_) {
        channel.held.clear();
        channel.days_read.clear();
    }
}

/// Returns a channel; in a replay it knows the records of the day of `start` in the archive.
Writer::Channel& Writer::replayed(const std::string& name, UtcTime start) const {
    Channel& channel = channels_[name];
    const auto day_file = sds_file(archive_, codes_, name, start);
    if (is_replaying_ && channel.days_read.insert(day_file).second &&
        std::filesystem::exists(day_file))
        load(channel, day_file);
    return channel;
}

void Writer::load(Channel& channel, const std::filesystem::path& day_file) const {
    files_.open_append(day_file)->sync();
    for (auto directory = day_file.parent_path(); directory != archive_.parent_path();
         directory = directory.parent_path())
        files_.sync_directory(directory);
    auto in = open_day_file(day_file);
    std::array<std::byte, kRecordSize> bytes{};
    for (std::uint64_t offset = 0; read_record(in, bytes); offset += kRecordSize) {
        const auto record = decode_record(bytes);
        if (!record) continue;
        ArchivedRecord archived = describe(*record);
        archived.day = std::chrono::floor<std::chrono::days>(record->header.start);
        archived.offset = offset;
        channel.held.emplace(record->header.start, std::move(archived));
    }
}

void Writer::begin_session() {
    ++session_count_;
    for (auto& [name, channel] : channels_) channel.newest.reset();
}

void Writer::reopen() {
    sds_ = std::make_unique<SdsWriter>(files_, archive_, codes_);
    for (auto& [name, channel] : channels_) channel.sequence.reset();
}

std::optional<std::size_t> Writer::samples_in_archive(const std::string& name,
                                                      UtcTime start) const {
    if (!is_replaying_) return std::nullopt;
    const Channel& channel = replayed(name, start);
    const auto held = channel.held.find(start);
    if (held == channel.held.end()) return std::nullopt;
    return held->second.sample_count;
}

Writer::Held Writer::held() const {
    Held held;
    if (!is_replaying_) return held;
    for (const std::string& name : channels_in(archive_, codes_)) {
        const auto day_file = newest_day_file(archive_, codes_, name);
        Channel& channel = channels_[name];
        if (day_file && channel.days_read.insert(*day_file).second) load(channel, *day_file);
    }
    for (const auto& [name, channel] : channels_)
        for (const auto& [start, record] : channel.held)
            held[name].emplace(start, record.sample_count);
    return held;
}

Writer::Found Writer::find(const std::string& name, const PackedRecord& record) {
    if (!is_replaying_) return Found::nothing;
    Channel& channel = replayed(name, record.start);
    if (channel.held.empty()) return Found::nothing;
    const ArchivedRecord made = describe(decode_own(record));
    const auto [begin, end] = channel.held.equal_range(record.start);
    for (auto held = begin; held != end; ++held) {
        if (held->second.sample_count != made.sample_count ||
            held->second.samples_hash != made.samples_hash)
            continue;
        settle(name, channel, &held->second);
        channel.matched[held->second.day] = held->second.offset;
        channel.newest_match = held->second.sequence;
        channel.held.erase(held);
        return Found::same;
    }
    const auto overlaps = [&](const auto& held) {
        return held.first < made.end && held.second.end > record.start;
    };
    return std::ranges::any_of(channel.held, overlaps) ? Found::other : Found::nothing;
}

/// Decides on the records held back before a match, or at the end if it is null.
void Writer::settle(const std::string& name, Channel& channel, const ArchivedRecord* next) {
    const auto is_between_matches = [&](const ArchivedRecord& held) {
        const auto last = channel.matched.find(held.day);
        const bool is_earlier =
            last != channel.matched.end()
                ? held.offset < last->second
                : channel.newest_match && precedes(held.sequence, *channel.newest_match);
        if (is_earlier) return false;
        return next == nullptr || held.day != next->day || held.offset < next->offset;
    };
    for (; !channel.held_back.empty(); channel.held_back.pop_front()) {
        const Newest& made = channel.held_back.front();
        const UtcTime end = describe(decode_own(made.record)).end;
        const auto is_in_its_place = [&](const auto& held) {
            return held.first < end && held.second.end > made.record.start &&
                   is_between_matches(held.second);
        };
        if (std::ranges::any_of(channel.held, is_in_its_place))
            ++replay_conflicts_;
        else
            write(name, channel, made);
    }
}

void Writer::settle() {
    for (auto& [name, channel] : channels_) settle(name, channel, nullptr);
}

/// Returns the sequence number of the record written last.  After a clock was set back over
/// midnight, that record is not in the file of the newest day.
int Writer::newest_sequence(const std::string& channel) const {
    int newest = 0;
    for (const auto& day_file : recent_day_files(archive_, codes_, channel)) {
        const int last = last_sequence(day_file);
        if (newest == 0 || (last != 0 && precedes(newest, last))) newest = last;
    }
    return newest;
}

void Writer::record(const std::string& name, const PackedRecord& record, std::int64_t last_index) {
    const Found found = find(name, record);
    Channel& channel = channels_[name];
    const Newest made{record, last_index, session_count_};
    switch (found) {
        case Found::other:
            channel.held_back.push_back(made);
            break;
        case Found::same:
            ++records_skipped_;
            channel.newest = made;
            break;
        case Found::nothing:
            write(name, channel, made);
            break;
    }
}

void Writer::write(const std::string& name, Channel& channel, const Newest& made) {
    if (!channel.sequence) channel.sequence = newest_sequence(name);
    const int sequence = *channel.sequence % kLargestSequence + 1;
    PackedRecord numbered = made.record;
    stamp_sequence(numbered, sequence);
    sds_->append(name, numbered);
    channel.sequence = sequence;
    ++records_written_;
    if (made.session == session_count_) channel.newest = made;
}

std::vector<journal::ChannelMark> Writer::sync() {
    sds_->sync();
    std::vector<journal::ChannelMark> marks;
    for (const auto& [name, channel] : channels_) {
        if (!channel.newest) continue;
        const DecodedRecord record = decode_own(channel.newest->record);
        marks.push_back({name, channel.newest->last_index, record.last_sample()});
    }
    return marks;
}

}  // namespace a351::archive
