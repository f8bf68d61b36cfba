#include "protocol/record/archive_writer.hpp"

#include <cerrno>
#include <charconv>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "protocol/record/miniseed_layout.hpp"

namespace a351::record {
namespace {

constexpr int kLargestSequence = 999'999;
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

void stamp_sequence(PackedRecord& record, int sequence) {
    for (std::size_t digit = kSequenceDigits; digit-- > 0; sequence /= 10)
        record.bytes[kSequenceAt + digit] =
            std::byte(static_cast<unsigned char>('0' + sequence % 10));
}

UtcTime last_sample_of(const DecodedRecord& record) {
    return record.header.start +
           from_seconds(static_cast<double>(record.samples.size() - 1) / record.rate_hz());
}

}  // namespace

ArchiveWriter::ArchiveWriter(FileLayer& files, std::filesystem::path archive, StationCodes codes)
    : files_(files),
      archive_(std::move(archive)),
      codes_(std::move(codes)),
      sds_(std::make_unique<SdsWriter>(files_, archive_, codes_)) {}

ArchiveWriter::Held ArchiveWriter::describe(const DecodedRecord& record) {
    const std::string_view bytes(reinterpret_cast<const char*>(record.samples.data()),
                                 record.samples.size() * sizeof(std::int32_t));
    return {record.samples.size(), std::hash<std::string_view>()(bytes),
            last_sample_of(record) + from_seconds(0.5 / record.rate_hz())};
}

void ArchiveWriter::begin_replay(UtcTime since) {
    for (const auto& name : channels_in(archive_, codes_)) {
        Channel& channel = channels_[name];
        channel.held.clear();
        const auto oldest = sds_file(archive_, codes_, name, since);
        for (const auto& day_file : day_files(archive_, codes_, name)) {
            if (day_file < oldest) continue;
            files_.open_append(day_file)->sync();
            load(channel, day_file, since);
        }
    }
}

void ArchiveWriter::load(Channel& channel, const std::filesystem::path& day_file, UtcTime since) {
    auto in = open_day_file(day_file);
    std::array<std::byte, kRecordSize> bytes{};
    while (read_record(in, bytes)) {
        const auto record = decode_record(bytes);
        if (record && record->header.start >= since)
            channel.held.emplace(record->header.start, describe(*record));
    }
}

void ArchiveWriter::begin_session() {
    for (auto& [name, channel] : channels_) channel.newest.reset();
}

void ArchiveWriter::reopen() {
    sds_ = std::make_unique<SdsWriter>(files_, archive_, codes_);
    for (auto& [name, channel] : channels_) channel.sequence.reset();
}

std::optional<std::size_t> ArchiveWriter::samples_held(const std::string& channel,
                                                       UtcTime start) const {
    const auto found = channels_.find(channel);
    if (found == channels_.end()) return std::nullopt;
    const auto held = found->second.held.find(start);
    if (held == found->second.held.end()) return std::nullopt;
    return held->second.sample_count;
}

bool ArchiveWriter::pass_over(Channel& channel, const PackedRecord& record) {
    if (channel.held.empty()) return false;
    if (channel.held.rbegin()->second.end <= record.start) {
        channel.held.clear();
        return false;
    }
    const Held made = describe(*decode_record(record.bytes));
    const auto after = channel.held.lower_bound(record.start);
    if (after != channel.held.end() && after->first == record.start) {
        const bool is_same = after->second.sample_count == made.sample_count &&
                             after->second.samples_hash == made.samples_hash;
        ++(is_same ? records_passed_over_ : replay_conflicts_);
        return true;
    }
    const bool overlaps =
        (after != channel.held.end() && after->first < made.end) ||
        (after != channel.held.begin() && std::prev(after)->second.end > record.start);
    if (overlaps) ++replay_conflicts_;
    return overlaps;
}

int ArchiveWriter::newest_sequence(const std::string& channel) const {
    const auto day_file = newest_day_file(archive_, codes_, channel);
    if (!day_file) return 0;
    const auto size = std::filesystem::file_size(*day_file);
    if (size < kRecordSize) return 0;
    auto in = open_day_file(*day_file);
    in.seekg(static_cast<std::streamoff>((size / kRecordSize - 1) * kRecordSize));
    std::array<char, kSequenceDigits> digits{};
    in.read(digits.data(), digits.size());
    int sequence = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), sequence);
    return sequence;
}

void ArchiveWriter::record(const std::string& name, const PackedRecord& record,
                           std::int64_t last_index) {
    Channel& channel = channels_[name];
    if (!pass_over(channel, record)) {
        if (!channel.sequence) channel.sequence = newest_sequence(name);
        const int sequence = *channel.sequence % kLargestSequence + 1;
        PackedRecord numbered = record;
        stamp_sequence(numbered, sequence);
        sds_->append(name, numbered);
        channel.sequence = sequence;
        ++records_written_;
    }
    channel.newest = Newest{record, last_index};
}

std::vector<ChannelMark> ArchiveWriter::sync() {
    sds_->sync();
    std::vector<ChannelMark> marks;
    for (const auto& [name, channel] : channels_) {
        if (!channel.newest) continue;
        const auto record = decode_record(channel.newest->record.bytes);
        marks.push_back({name, channel.newest->last_index, last_sample_of(*record)});
    }
    return marks;
}

}  // namespace a351::record
