#include "protocol/archive/record_file.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace a351::archive {
namespace {

/// Bytes of a piece: its records, decoded, fit into the cache.
constexpr std::uint64_t kPieceSize = 1U << 16U;

}  // namespace

RecordFile::RecordFile(std::filesystem::path file, std::string channel)
    : file_(std::move(file)),
      in_(file_, std::ios::binary),
      channel_(std::move(channel)),
      size_(std::filesystem::file_size(file_)) {}

std::vector<std::byte> RecordFile::bytes(std::uint64_t offset, std::uint64_t count) {
    std::vector<std::byte> read(count);
    in_.seekg(static_cast<std::streamoff>(offset));
    in_.read(reinterpret_cast<char*>(read.data()), static_cast<std::streamsize>(count));
    if (!in_) throw std::system_error(EIO, std::generic_category(), "read " + file_.string());
    return read;
}

std::optional<FoundRecord> RecordFile::next() {
    while (next_ == found_.size() && read_to_ < size_) {
        const std::uint64_t begin = read_to_;
        const auto piece = bytes(begin, std::min(kPieceSize, size_ - begin));
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
