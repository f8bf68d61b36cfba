#include "protocol/journal/journal_writer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "protocol/core/invariant.hpp"
#include "protocol/journal/journal_codec.hpp"
#include "protocol/journal/journal_reader.hpp"

namespace a351::journal {

namespace {

// Most memory that is kept after a sync, bytes: a second of the fastest line, and as much again.
constexpr std::size_t kMostKeptBytes = std::size_t{4} << 20;

std::string segment_name(std::uint64_t number, UtcTime time) {
    return fmt::format("{:08}_{}.a351j", number, to_compact(time));
}

/// Removes a file on a disk so full or faulty that the header could not be written.
void remove_if_possible(files::FileLayer& files, const std::filesystem::path& path) {
    try {
        files.remove(path);
    } catch (const std::system_error&) {
        // Readers skip a segment without a header.
    }
}

}  // namespace

Writer::Writer(files::FileLayer& files, std::filesystem::path directory)
    : files_(files), directory_(std::move(directory)) {
    files_.create_directories(directory_);
    for (const auto& entry : std::filesystem::directory_iterator(directory_)) {
        // Compressed and torn segments keep their number, so every name counts.
        if (const auto number = segment_number(entry.path())) number_ = std::max(number_, *number);
    }
}

void Writer::begin_segment(const Header& header) {
    sync();
    segment_.reset();
    open_segment(header);
    header_ = header;
    newest_clock_ = header.clock;
    forget_unsynced();
}

void Writer::append(const Chunk& chunk) {
    require_invariant(header_.has_value(), "a segment is begun before a chunk");
    if (!segment_) rewrite_unsynced();
    const std::size_t before = unsynced_.size();
    append_chunk(unsynced_, chunk, next_sequence_);
    try {
        write(std::span(unsynced_).subspan(before));
    } catch (...) {
        unsynced_.resize(before);
        throw;
    }
    ++unsynced_count_;
    require_invariant(next_sequence_ - first_unsynced_ == unsynced_count_,
                      "each chunk after the last sync is in memory, once");
    if (const auto* reading = std::get_if<timing::ClockReading>(&chunk)) newest_clock_ = *reading;
}

std::optional<Header> Writer::append(const Chunk& chunk, const timing::ClockReading& clock) {
    require_invariant(header_.has_value(), "a segment is begun before a chunk");
    if (!segment_) rewrite_unsynced();
    const bool is_full =
        clock.raw - header_->clock.raw >= kLongestSegment || segment_->size() >= kLargestSegment;
    if (is_full) {
        Header header = *header_;
        header.clock = clock;
        begin_segment(header);
        unreported_header_ = header;
    }
    append(chunk);
    return std::exchange(unreported_header_, std::nullopt);
}

void Writer::sync() {
    if (!segment_ && unsynced_.empty()) return;
    if (!segment_) rewrite_unsynced();
    try {
        segment_->sync();
    } catch (...) {
        give_up();
        throw;
    }
    forget_unsynced();
}

// Writes the unsynced chunks into a new segment after a fault; does not sync.
void Writer::rewrite_unsynced() {
    Header header = *header_;
    header.clock = synced_clock_;
    open_segment(header);
    for (auto left = std::span(unsynced_); !left.empty();) {
        const auto chunk = left.first(kChunkHeaderSize + decode_chunk_header(left).length);
        renumber_chunk(chunk, next_sequence_);
        write(chunk);
        left = left.subspan(chunk.size());
    }
}

void Writer::open_segment(const Header& header) {
    Header head = header;
    head.repeats = lost_from_;
    const auto path = directory_ / segment_name(++number_, header.clock.realtime);
    auto bytes = encode_preamble();
    append_chunk(bytes, head, 0);
    auto segment = files_.create(path);
    try {
        segment->append(bytes);
        segment->sync();
        files_.sync_directory(directory_);
    } catch (...) {
        remove_if_possible(files_, path);
        throw;
    }
    segment_ = std::move(segment);
    next_sequence_ = first_unsynced_ = 1;
    bytes_written_ += bytes.size();
}

void Writer::write(std::span<const std::byte> chunk) {
    try {
        segment_->append(chunk);
    } catch (...) {
        give_up();
        throw;
    }
    ++next_sequence_;
    bytes_written_ += chunk.size();
}

// If chunks cannot be written again either, the place where they were first is kept.
void Writer::give_up() noexcept {
    segment_.reset();
    if (!lost_from_) lost_from_ = RepeatedChunks{number_, first_unsynced_};
}

void Writer::forget_unsynced() {
    unsynced_.clear();
    if (unsynced_.capacity() > kMostKeptBytes) unsynced_.shrink_to_fit();
    unsynced_count_ = 0;
    lost_from_.reset();
    require_invariant(first_unsynced_ <= next_sequence_, "sequence numbers ascend");
    first_unsynced_ = next_sequence_;
    synced_clock_ = newest_clock_;
}

}  // namespace a351::journal
