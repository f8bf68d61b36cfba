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
/// A failed write or sync is never repeated on the same file, because the kernel may have dropped
/// the data and report success the next time.  The segment is left as it is.  The chunks after its
/// last good sync are kept in memory and written again into the next segment, whose header says so
/// (`repeats`).
class JournalWriter {
public:
    /// Continues the segment counter found in `directory`, which is created when absent.
    JournalWriter(FileLayer& files, std::filesystem::path directory);

    /// Syncs and closes the current segment and begins a new one: writes and syncs its header, then
    /// syncs the directory.
    /// @throws std::system_error  the segment could not be begun.  A file without a header is
    ///         removed, if the disk permits it.
    void begin_segment(const JournalHeader& header);

    /// Appends a chunk by one write.  If the segment is older than one hour of raw time or larger
    /// than 64 MiB, a new one is begun first, with the same header and `clock`.
    /// Precondition: begin_segment() was called.
    /// @return  the header of a segment that was begun so; a reader finds it before `chunk`.
    /// @throws std::system_error  `chunk` is not written; earlier chunks are kept.
    /// @throws std::invalid_argument  the chunk is larger than kMostPayloadBytes.
    std::optional<JournalHeader> append(const JournalChunk& chunk,
                                        const timing::ClockReading& clock);

    /// Syncs all chunks to disk.
    /// @throws std::system_error  the unsynced chunks are kept; the next call writes them again.
    void sync();

    /// Returns the number of bytes written to all segments since construction.
    [[nodiscard]] std::uint64_t bytes_written() const noexcept { return bytes_written_; }

private:
    void open_segment(const JournalHeader& header);
    void write(const JournalChunk& chunk);
    void give_up() noexcept;
    void rewrite_unsynced();
    void forget_unsynced();

    FileLayer& files_;
    std::filesystem::path directory_;
    std::optional<JournalHeader> header_;  ///< Header of begin_segment() or of the last rotation.
    std::optional<JournalHeader>
        unreported_header_;  ///< Header of a rotation that append() has to return.
    std::unique_ptr<AppendFile> segment_;
    std::uint64_t number_ = 0;  ///< Number of the newest segment.
    std::uint32_t next_sequence_ = 0;
    std::vector<JournalChunk> unsynced_;
    std::optional<RepeatedChunks> lost_from_;  ///< First place of unsynced_, if that sync failed.
    std::uint32_t first_unsynced_ = 1;         ///< First unsynced chunk of the open segment.
    timing::ClockReading newest_clock_, synced_clock_;
    std::uint64_t bytes_written_ = 0;
};

}  // namespace a351::record
