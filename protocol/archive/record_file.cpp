#include "protocol/archive/record_file.hpp"

#include <algorithm>
#include <utility>

#include "protocol/files/file_bytes.hpp"

namespace a351::archive {
namespace {

/// Bytes of a piece: its records, decoded, fit into the cache.
constexpr std::uint64_t kPieceSize = 1U << 16U;

}  // namespace

RecordFile::RecordFile(std::filesystem::path file, std::string channel)
    : file_(std::move(file)),
      channel_(std::move(channel)),
      size_(std::filesystem::file_size(file_)) {}

std::optional<FoundRecord> RecordFile::next() {
    while (next_ == found_.size() && read_to_ < size_) {
        const std::uint64_t begin = read_to_;
        const auto piece = files::read_bytes(file_, begin, std::min(kPieceSize, size_ - begin));
        found_ = find_records(piece, channel_);
        next_ = 0;
        for (FoundRecord& one : found_) one.offset += begin;
        read_to_ += piece.size();
        if (read_to_ == size_) break;
        // The last bytes may be the begin of a record.
        read_to_ -= kRecordSize - 1;
        if (!found_.empty()) read_to_ = std::max(read_to_, found_.back().offset + kRecordSize);
    }
    skipped_at_ = end_;
    if (next_ == found_.size()) {
        skipped_ = size_ - std::exchange(end_, size_);
        return std::nullopt;
    }
    FoundRecord& found = found_[next_++];
    skipped_ = found.offset - end_;
    end_ = found.offset + kRecordSize;
    return std::move(found);
}

}  // namespace a351::archive
