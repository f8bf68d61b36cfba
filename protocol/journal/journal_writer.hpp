#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::record {

/// Appends chunks to segments `NNNNNNNN_YYYYMMDDThhmmssZ.a351j`.  One writer per directory.
///
/// A write or sync that failed is never tried again on the same file, for the kernel may have
/// dropped what it could not write and report success next time.  The segment is left as it is; what
/// followed its last good sync is kept in memory and written again into the next one, whose header
/// says so (`repeats`).
class JournalWriter {
public:
    /// Continues the segment counter found in `directory`, which is created when absent.
    JournalWriter(FileLayer& files, std::filesystem::path directory);

    /// Begins a segment: header written and synced, then the directory.  Syncs and closes the one
    /// before.
    /// @throws std::system_error  no file is left that has no header, unless the disk is so bad that
    ///         it cannot be removed either.
    void begin_segment(const JournalHeader& header);

    /// One write per chunk.  A segment older than one hour of raw time, or larger than 64 MiB, is
    /// closed first and a new one begun with the same header and `clock`.
    /// Precondition: begin_segment() was called.
    /// @return  the header of a segment begun so, which a reader meets before `chunk`.
    /// @throws std::system_error  `chunk` is not written; those before are kept.
    /// @throws std::invalid_argument  the chunk is larger than kMostPayloadBytes.
    std::optional<JournalHeader> append(const JournalChunk& chunk,
                                        const timing::ClockReading& clock);

    /// All chunks are on disk.
    /// @throws std::system_error  they are kept; the next call writes them again.
    void sync();

    /// Bytes written to all segments since construction.
    [[nodiscard]] std::uint64_t bytes_written() const noexcept { return bytes_written_; }

private:
    void open_segment(const JournalHeader& header);
    void write(const JournalChunk& chunk);
    void give_up() noexcept;
    void write_again();
    void forget_unsynced();

    FileLayer& files_;
    std::filesystem::path directory_;
    std::optional<JournalHeader> header_;  ///< As begin_segment() or the last rotation had it.
    std::optional<JournalHeader> untold_;  ///< Of a rotation, until append() returns it.
    std::unique_ptr<AppendFile> segment_;
    std::uint64_t number_ = 0;  ///< Of the newest segment.
    std::uint32_t next_sequence_ = 0;
    std::vector<JournalChunk> unsynced_;
    std::optional<RepeatedChunks> lost_from_;  ///< Where unsynced_ stood first, if that failed.
    std::uint32_t first_unsynced_ = 1;         ///< Of the segment that is open.
    timing::ClockReading newest_clock_, synced_clock_;
    std::uint64_t bytes_written_ = 0;
};

}  // namespace a351::record
