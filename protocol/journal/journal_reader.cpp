#include "protocol/journal/journal_reader.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <system_error>
#include <utility>

#include "protocol/core/whole_number.hpp"
#include "protocol/files/file_bytes.hpp"
#include "protocol/journal/chunk_payload.hpp"
#include "protocol/journal/journal_compression.hpp"

namespace a351::journal {
namespace {

bool is_compressed(const std::filesystem::path& segment) { return segment.extension() == ".zst"; }

/// Bytes in which a good chunk is searched for at once.
constexpr std::size_t kSearchedBytes = std::size_t{64} * 1024;

/// Returns true if these 13 bytes may begin a chunk that follows chunk `next` - 1.
/// @param rest  bytes of the segment from the header's end on.
bool may_follow(const ChunkHeader& header, std::uint32_t next, std::uint64_t rest,
                std::uint64_t size) {
    return header.length <= kMostPayloadBytes && header.length <= rest && header.type != 0 &&
           header.sequence >= next && header.sequence - next <= size / kChunkHeaderSize;
}

}  // namespace

Reader::Reader(std::filesystem::path segment) : path_(std::move(segment)) {
    if (is_compressed(path_)) {
        try {
            const auto bytes = decompress_segment(path_);
            size_ = bytes.size();
            in_ = std::make_unique<std::istringstream>(
                std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
        } catch (const std::runtime_error& error) {
            size_ = std::filesystem::file_size(path_);
            refuse(error.what());
        }
        return;
    }
    in_ = std::make_unique<std::ifstream>(path_, std::ios::binary);
    if (!*in_) throw std::system_error(errno, std::generic_category(), "open " + path_.string());
    size_ = std::filesystem::file_size(path_);
}

bool Reader::read(std::uint64_t at, std::span<std::byte> bytes) {
    if (at != position_) {
        in_->clear();
        in_->seekg(static_cast<std::streamoff>(at));
    }
    in_->read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    position_ = at + bytes.size();
    return in_->good();
}

/// Ends the segment.  Without a header all of it is damage.
std::optional<Chunk> Reader::refuse(std::string reason) {
    damage_.push_back({path_, offset_, size_ - offset_, std::move(reason)});
    is_over_ = true;
    return std::nullopt;
}

Reader::Look Reader::look_at(std::uint64_t at) {
    std::array<std::byte, kChunkHeaderSize> head{};
    Look look;
    const auto refused = [&look](const char* trouble) {
        look.trouble = trouble;
        return look;
    };
    if (size_ - at < head.size() || !read(at, head)) return refused("torn chunk header");
    look.header = decode_chunk_header(head);
    const ChunkHeader& header = look.header;
    if (header.length > kMostPayloadBytes) return refused("impossible length");
    if (size_ - at - head.size() < header.length) return refused("torn chunk");
    payload_.resize(header.length);
    if (!read(at + head.size(), payload_)) return refused("torn chunk");
    if (chunk_crc(header, payload_) != header.crc) return refused("wrong checksum");
    const bool is_head = header.type == static_cast<std::uint8_t>(ChunkType::head);
    if (is_head != (header.sequence == 0))
        return refused(is_head ? "header inside the segment" : "no header");
    if (is_known(header.type)) {
        look.chunk = decode_payload(static_cast<ChunkType>(header.type), payload_);
        if (!look.chunk) return refused("payload does not fit its type");
    }
    return look;
}

std::optional<Reader::Place> Reader::search(std::uint64_t from) {
    std::vector<std::byte> bytes;
    for (std::uint64_t at = from; size_ - at >= kChunkHeaderSize;) {
        bytes.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kSearchedBytes, size_ - at)));
        if (!read(at, bytes)) return std::nullopt;
        const std::size_t places = bytes.size() - kChunkHeaderSize + 1;
        for (std::size_t i = 0; i < places; ++i, ++at) {
            const auto header = decode_chunk_header(std::span(bytes).subspan(i, kChunkHeaderSize));
            if (!may_follow(header, next_sequence_, size_ - at - kChunkHeaderSize, size_)) continue;
            if (look_at(at).trouble == nullptr) return Place{at, header.sequence};
        }
    }
    return std::nullopt;
}

std::optional<Chunk> Reader::next() {
    if (is_over_) return std::nullopt;
    if (offset_ == 0) {
        std::array<std::byte, kPreambleSize> preamble{};
        if (size_ < kPreambleSize || !read(0, preamble)) return refuse("shorter than its preamble");
        if (!is_preamble(preamble)) return refuse("not a journal of this version");
        if (size_ == kPreambleSize) return refuse("no header");
        // offset_ stays 0 until the header is read: without it the whole file is damaged.
    }
    while (offset_ < size_) {
        const std::uint64_t at = std::max<std::uint64_t>(offset_, kPreambleSize);
        Look look = look_at(at);
        if (look.trouble == nullptr && look.header.sequence != next_sequence_)
            look.trouble = "wrong sequence number";
        if (look.trouble != nullptr) {
            if (offset_ == 0) return refuse(look.trouble);
            const auto found = search(offset_);
            if (!found) return refuse(look.trouble);
            damage_.push_back(
                {path_, offset_, found->offset - offset_, look.trouble, found->sequence});
            offset_ = found->offset;
            next_sequence_ = found->sequence;
            continue;
        }
        offset_ = at + kChunkHeaderSize + look.header.length;
        sequence_ = next_sequence_++;
        if (look.chunk) return look.chunk;
    }
    return std::nullopt;
}

bool is_repeated_later(const Damage& damage, const Header& header, const Header& next) {
    if (!damage.next_sequence || !next.repeats) return false;
    // A further attempt repeats all that a failed one has, from chunk 1 on.
    if (next.repeats == header.repeats) return true;
    return next.repeats->segment == segment_number(damage.file) &&
           next.repeats->sequence < *damage.next_sequence;
}

bool Repetitions::is_repeated(std::uint64_t segment, std::uint32_t sequence, const Chunk& chunk) {
    if (const auto* header = std::get_if<Header>(&chunk)) {
        if (header->repeats && header->repeats != from_) {
            const bool was_read = last_segment_ == header->repeats->segment &&
                                  last_sequence_ >= header->repeats->sequence;
            chunks_read_ = was_read ? last_sequence_ - header->repeats->sequence + 1 : 0;
        }
        from_ = header->repeats;
        to_skip_ = from_ ? chunks_read_ : 0;
    } else if (sequence <= to_skip_) {
        return true;
    } else if (from_) {
        chunks_read_ = sequence;
    }
    last_segment_ = segment;
    last_sequence_ = sequence;
    return false;
}

Sequence::Sequence(std::vector<std::filesystem::path> segments) : segments_(std::move(segments)) {}

void Sequence::open_next() {
    const auto& segment = segments_[next_segment_++];
    number_ = segment_number(segment).value_or(0);
    damage_in_segment_ = 0;
    header_.reset();
    next_header_.reset();
    reader_.emplace(segment);
}

std::optional<Chunk> Sequence::next() {
    while (true) {
        if (!reader_) {
            if (next_segment_ == segments_.size()) return std::nullopt;
            open_next();
        }
        while (auto chunk = reader_->next()) {
            if (const auto* header = std::get_if<Header>(&*chunk)) header_ = *header;
            const std::size_t damages = reader_->damage().size();
            if (std::exchange(damage_in_segment_, damages) != damages && is_repeated_later()) break;
            if (!repetitions_.is_repeated(number_, reader_->sequence(), *chunk)) return chunk;
        }
        damage_.insert(damage_.end(), reader_->damage().begin(), reader_->damage().end());
        reader_.reset();
    }
}

bool Sequence::is_repeated_later() {
    if (!next_header_) {
        next_header_.emplace();
        for (std::size_t k = next_segment_; k < segments_.size() && !*next_header_; ++k) {
            try {
                *next_header_ = segment_header(segments_[k]);
            } catch (const std::system_error&) {
                // next() reports it when it comes to this segment.
            }
        }
    }
    return header_ && *next_header_ &&
           journal::is_repeated_later(reader_->damage().back(), *header_, **next_header_);
}

std::optional<Header> segment_header(const std::filesystem::path& segment) {
    Reader reader(segment);
    const auto chunk = reader.next();
    const auto* header = chunk ? std::get_if<Header>(&*chunk) : nullptr;
    return header ? std::optional(*header) : std::nullopt;
}

std::optional<MarkChunk> newest_mark(const std::filesystem::path& segment) {
    std::optional<MarkChunk> newest;
    Reader reader(segment);
    while (auto chunk = reader.next())
        if (auto* mark = std::get_if<MarkChunk>(&*chunk)) newest = std::move(*mark);
    return newest;
}

std::optional<UtcTime> segment_time(const std::filesystem::path& file) {
    const std::string name = file.filename().string();
    const auto bar = name.find('_');
    if (bar == std::string::npos || name.size() < bar + 17) return std::nullopt;
    std::string text = name.substr(bar + 1, 16);  // 20260301T120000Z
    for (const std::size_t colon : {13U, 11U}) text.insert(colon, ":");
    for (const std::size_t dash : {6U, 4U}) text.insert(dash, "-");
    return parse_rfc3339(text);
}

std::optional<std::uint64_t> segment_number(const std::filesystem::path& file) {
    const std::string name = file.filename().string();
    const auto bar = name.find('_');
    if (bar == std::string::npos || bar < 8 || bar > 18) return std::nullopt;
    if (name.find(".a351j") == std::string::npos) return std::nullopt;
    return parse_whole<std::uint64_t>(std::string_view(name).substr(0, bar));
}

std::vector<std::filesystem::path> segment_files(const std::filesystem::path& directory) {
    std::vector<std::pair<std::uint64_t, std::filesystem::path>> numbered;
    if (std::filesystem::exists(directory)) {
        for (const auto& entry : std::filesystem::directory_iterator(directory)) {
            const auto number = segment_number(entry.path());
            if (number && (entry.path().extension() == ".a351j" || is_compressed(entry.path())))
                numbered.emplace_back(*number, entry.path());
        }
    }
    // Sorted by number; an original precedes its compressed copy, which a crash may have left.
    std::sort(numbered.begin(), numbered.end());
    std::vector<std::filesystem::path> segments;
    std::optional<std::uint64_t> last;
    for (auto& [number, path] : numbered)
        if (std::exchange(last, number) != number) segments.push_back(std::move(path));
    return segments;
}

std::vector<AbsentSegments> absent_segments(const std::filesystem::path& directory) {
    std::map<std::uint64_t, std::filesystem::path> there;
    for (const auto& entry : std::filesystem::directory_iterator(directory))
        if (const auto number = segment_number(entry.path())) there[*number] = entry.path();
    std::vector<AbsentSegments> absent;
    for (auto before = there.begin(); before != there.end(); ++before) {
        const auto after = std::next(before);
        if (after != there.end() && after->first > before->first + 1)
            absent.push_back({before->first + 1, after->first - 1, before->second, after->second});
    }
    return absent;
}

std::optional<Damage> repair_newest_segment(files::FileLayer& files,
                                            const std::filesystem::path& directory) {
    const auto segments = segment_files(directory);
    if (segments.empty() || is_compressed(segments.back())) return std::nullopt;
    Reader reader(segments.back());
    while (reader.next()) {
    }
    if (reader.damage().empty() || reader.damage().back().next_sequence) {
        // The writer may have been killed before its last sync.
        files.open_append(segments.back())->sync();
        return std::nullopt;
    }
    const Damage& damage = reader.damage().back();
    auto side = damage.file;
    side += ".torn";
    if (damage.offset == 0) {
        files.rename(damage.file, side);
        files.sync_directory(directory);
    } else {
        files::replace_file(files, side,
                            files::read_own_bytes(damage.file, damage.offset, damage.byte_count));
        files.truncate(damage.file, damage.offset);
    }
    return damage;
}

}  // namespace a351::journal
