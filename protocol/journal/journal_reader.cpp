#include "protocol/journal/journal_reader.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "protocol/files/file_bytes.hpp"
#include "protocol/journal/journal_codec.hpp"
#include "protocol/journal/journal_compression.hpp"

namespace a351::journal {
namespace {

bool is_compressed(const std::filesystem::path& segment) { return segment.extension() == ".zst"; }

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
            stop(error.what());
        }
        return;
    }
    in_ = std::make_unique<std::ifstream>(path_, std::ios::binary);
    if (!*in_) throw std::system_error(errno, std::generic_category(), "open " + path_.string());
    size_ = std::filesystem::file_size(path_);
}

bool Reader::read(std::span<std::byte> bytes) {
    in_->read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return in_->good();
}

std::optional<Chunk> Reader::stop(std::string reason) {
    damage_ = Damage{path_, offset_, size_ - offset_, std::move(reason)};
    return std::nullopt;
}

std::optional<Chunk> Reader::next() {
    if (damage_) return std::nullopt;
    if (offset_ == 0) {
        std::array<std::byte, kPreambleSize> preamble{};
        if (size_ < kPreambleSize || !read(preamble)) return stop("shorter than its preamble");
        if (!is_preamble(preamble)) return stop("not a journal of this version");
        // offset_ stays 0 until the header is read: without it the whole file is damaged.
    }
    for (std::uint64_t at = std::max<std::uint64_t>(offset_, kPreambleSize); at < size_;
         at = offset_) {
        std::array<std::byte, kChunkHeaderSize> head{};
        if (size_ - at < head.size() || !read(head)) return stop("torn chunk header");
        const ChunkHeader chunk = decode_chunk_header(head);
        if (chunk.length > kMostPayloadBytes) return stop("impossible length");
        if (size_ - at - head.size() < chunk.length) return stop("torn chunk");
        payload_.resize(chunk.length);
        if (!read(payload_)) return stop("torn chunk");
        if (chunk_crc(chunk, payload_) != chunk.crc) return stop("wrong checksum");
        if (chunk.sequence != next_sequence_) return stop("wrong sequence number");
        const bool is_head = chunk.type == static_cast<std::uint8_t>(ChunkType::head);
        if (is_head != (chunk.sequence == 0))
            return stop(is_head ? "header inside the segment" : "no header");
        std::optional<Chunk> decoded;
        if (is_known(chunk.type)) {
            decoded = decode_payload(static_cast<ChunkType>(chunk.type), payload_);
            if (!decoded) return stop("payload does not fit its type");
        }
        offset_ = at + head.size() + chunk.length;
        sequence_ = next_sequence_++;
        if (decoded) return decoded;
    }
    if (next_sequence_ == 0) return stop("no header");
    return std::nullopt;
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

std::optional<Chunk> Sequence::next() {
    while (true) {
        if (!reader_) {
            if (next_segment_ == segments_.size()) return std::nullopt;
            const auto& segment = segments_[next_segment_++];
            number_ = segment_number(segment).value_or(0);
            reader_.emplace(segment);
        }
        while (auto chunk = reader_->next())
            if (!repetitions_.is_repeated(number_, reader_->sequence(), *chunk)) return chunk;
        if (reader_->damage()) damage_.push_back(*reader_->damage());
        reader_.reset();
    }
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
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + bar, number);
    if (error != std::errc() || end != name.data() + bar) return std::nullopt;
    return number;
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

std::optional<Damage> repair_newest_segment(files::FileLayer& files,
                                            const std::filesystem::path& directory) {
    const auto segments = segment_files(directory);
    if (segments.empty() || is_compressed(segments.back())) return std::nullopt;
    Reader reader(segments.back());
    while (reader.next()) {
    }
    const auto& damage = reader.damage();
    if (!damage) {
        // The writer may have been killed before its last sync.
        files.open_append(segments.back())->sync();
        return std::nullopt;
    }
    auto side = damage->file;
    side += ".torn";
    if (damage->offset == 0) {
        files.rename(damage->file, side);
        files.sync_directory(directory);
    } else {
        files::replace_file(files, side,
                            files::read_bytes(damage->file, damage->offset, damage->byte_count));
        files.truncate(damage->file, damage->offset);
    }
    return damage;
}

}  // namespace a351::journal
