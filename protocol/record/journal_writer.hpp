#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "protocol/record/file_layer.hpp"
#include "protocol/record/journal.hpp"

namespace a351::record {

/// Appends chunks to segments `NNNNNNNN_YYYYMMDDThhmmssZ.a351j`.  One writer per directory.
class JournalWriter {
public:
    /// Continues the segment counter found in `directory`, which is created when absent.
    JournalWriter(FileLayer& files, std::filesystem::path directory);

    /// Begins a segment: header written and synced, then the directory.  Closes the one before.
    /// @throws std::system_error  no file is left that has no header, unless the disk is so bad that
    ///         it cannot be removed either.
    void begin_segment(const JournalHeader& header);

    /// One write per chunk.  A segment older than one hour of raw time, or larger than 64 MiB, is
    /// closed first and a new one begun with the same header and `clock`.
    /// Precondition: begin_segment() was called.
    /// @return true when a segment was begun, whose header a reader meets before `chunk`.
    /// @throws std::system_error  the segment is given up, as after a failed sync(): what was not
    ///         synced may be lost.  The next append() begins a new segment.
    /// @throws std::invalid_argument  the chunk is larger than kMostPayloadBytes.
    bool append(const JournalChunk& chunk, const timing::ClockReading& clock);

    void sync();

    /// Bytes written to all segments since construction.
    [[nodiscard]] std::uint64_t bytes_written() const noexcept;

private:
    FileLayer& files_;
    std::filesystem::path directory_;
    std::optional<JournalHeader> header_;
    std::unique_ptr<AppendFile> segment_;
    std::uint64_t next_number_ = 1;
    std::uint32_t next_sequence_ = 0;
    std::uint64_t bytes_written_ = 0;
};

}  // namespace a351::record
