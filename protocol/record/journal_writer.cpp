#include "protocol/record/journal_writer.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cstdio>
#include <system_error>
#include <utility>

#include "protocol/record/journal_codec.hpp"
#include "protocol/record/journal_reader.hpp"

namespace a351::record {

namespace {

constexpr std::chrono::hours kLongestSegment{1};
constexpr std::uint64_t kLargestSegment = 64ULL << 20;

std::string segment_name(std::uint64_t number, UtcTime time) {
    // "2026-03-01T13:00:00Z" without its punctuation.
    std::string stamp = to_rfc3339(time);
    std::erase_if(stamp, [](char c) { return c == '-' || c == ':'; });
    std::string digits = std::to_string(number);
    digits.insert(0, digits.size() < 8 ? 8 - digits.size() : 0, '0');
    return digits + "_" + stamp + ".a351j";
}

/// On a disk that is full or bad enough to refuse a header.
void remove_if_possible(FileLayer& files, const std::filesystem::path& path) {
    try {
        files.remove(path);
    } catch (const std::system_error&) {
        // Readers pass over a segment without a header.
    }
}

}  // namespace

JournalWriter::JournalWriter(FileLayer& files, std::filesystem::path directory)
    : files_(files), directory_(std::move(directory)) {
    files_.create_directories(directory_);
    for (const auto& entry : std::filesystem::directory_iterator(directory_)) {
        // Compressed and torn segments keep their number, so every name counts.
        if (const auto number = segment_number(entry.path())) {
            next_number_ = std::max(next_number_, *number + 1);
        }
    }
}

void JournalWriter::begin_segment(const JournalHeader& header) {
    if (segment_) sync();
    segment_.reset();
    header_ = header;
    next_sequence_ = 0;
    const auto path = directory_ / segment_name(next_number_, header.clock.realtime);
    auto bytes = encode_preamble();
    const auto chunk = encode_chunk(header, next_sequence_++);
    bytes.insert(bytes.end(), chunk.begin(), chunk.end());
    ++next_number_;  // Also when what follows fails: the name is taken.
    auto segment = files_.open_append(path);
    try {
        segment->append(bytes);
        segment->sync();
        files_.sync_directory(directory_);
    } catch (...) {
        remove_if_possible(files_, path);
        throw;
    }
    segment_ = std::move(segment);
    bytes_written_ += bytes.size();
}

bool JournalWriter::append(const JournalChunk& chunk, const timing::ClockReading& clock) {
    assert(header_);
    const bool is_full = segment_ && (clock.raw - header_->clock.raw >= kLongestSegment ||
                                      segment_->size() >= kLargestSegment);
    const bool begins_segment = !segment_ || is_full;
    if (begins_segment) {
        JournalHeader header = *header_;
        header.clock = clock;
        begin_segment(header);
    }
    const auto bytes = encode_chunk(chunk, next_sequence_);
    try {
        segment_->append(bytes);
    } catch (...) {
        segment_.reset();
        throw;
    }
    ++next_sequence_;
    bytes_written_ += bytes.size();
    return begins_segment;
}

void JournalWriter::sync() {
    if (!segment_) return;
    try {
        segment_->sync();
    } catch (...) {
        segment_.reset();
        throw;
    }
}

std::uint64_t JournalWriter::bytes_written() const noexcept { return bytes_written_; }

}  // namespace a351::record
