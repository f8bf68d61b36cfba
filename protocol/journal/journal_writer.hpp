#pragma once
/// @file
/// Writes the journal so that synced chunks survive any crash, and failed writes lose nothing that
/// memory still holds.  Format: protocol/journal/journal-format.md.
///
///     repair_newest_segment(files, directory);  // journal_reader.hpp; before the writer exists.
///     Writer writer(files, directory);
///     writer.begin_segment(header);             // Once per session.
///     writer.append(chunk, clock);              // Many times.
///     writer.sync();                            // A crash loses what follows the last one.
///
/// A chunk is safe after the sync() that follows it.  All errors of the disk are exceptions, and
/// every call may simply be repeated after one.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::journal {

/// Limits of a segment: raw time and bytes after which a new one is begun.
inline constexpr std::chrono::hours kLongestSegment{1};
inline constexpr std::uint64_t kLargestSegment = std::uint64_t{64} << 20;

/// Appends chunks to segments `NNNNNNNN_YYYYMMDDThhmmssZ.a351j`.  One writer per directory.
///
/// A failed write or sync is never repeated on the same file, because the kernel may have dropped
/// the data and report success the next time.  The segment is left as it is.  The chunks after its
/// last good sync are kept in memory and written again into the next segment, whose header says so
/// (`repeats`).
///
/// Every chunk appended since the last good sync() is therefore in memory.  Without sync() this
/// memory grows without limit.  It is used again after the sync, so that append() and sync() do not
/// allocate at a steady rate.
///
/// Whichever operation of the disk fails, once or twice, a reader finds every appended chunk once
/// and in order (journal_writer_test.cpp).
///
/// There are no locks: use an object from one thread at a time.  No clock is read: all times are
/// arguments.  The destructor closes the segment without a sync.
class Writer {
public:
    /// Continues the segment counter found in `directory`, which is created when absent.
    ///
    /// Compressed, torn and partial segments count too, so no number is used twice.  No segment is
    /// written before begin_segment().
    ///
    /// @param files  must outlive this object.
    /// @throws std::system_error  the directory cannot be created or listed.
    Writer(files::FileLayer& files, std::filesystem::path directory);

    /// Syncs and closes the current segment and begins a new one: writes and syncs its header, then
    /// syncs the directory.
    ///
    /// After an exception call it again.  Do not call append() until it succeeds: the chunks would
    /// follow the previous header.  The number of a failed segment is not used again.
    ///
    /// @param header  header of this and of the following segments, up to the next call.  Its clock
    ///                gives the file name and the begin of the hour; `repeats` is ignored.
    /// @throws std::system_error  the segment could not be begun.  A file without a header is
    ///         removed, if the disk permits it.
    /// @throws std::invalid_argument  the header is larger than kMostPayloadBytes.
    void begin_segment(const Header& header);

    /// Appends a chunk by one write, to the segment that is open, whatever its age and size.
    /// Precondition: begin_segment() was called.
    ///
    /// The writer keeps the bytes of the chunk, not the chunk.  After std::system_error, append the
    /// same chunk again: it was not kept.
    ///
    /// @param chunk  any kind but Header, which would end the segment for every reader; this
    ///               is not checked.  Use begin_segment() for a header.
    /// @throws std::system_error  `chunk` is not written; earlier chunks are kept.
    /// @throws std::invalid_argument  the chunk is larger than kMostPayloadBytes, or violates the
    ///         format in another way that encode_chunk() refuses.  The writer is not affected.
    void append(const Chunk& chunk);

    /// Appends a chunk like the other function.  If the segment is older than kLongestSegment or
    /// larger than kLargestSegment, a new one is begun first, with the same header and `clock`.
    ///
    /// @param clock  present reading of the host's clocks; used only if a new segment is begun.
    /// @return  the header of a segment that was begun so; a reader finds it before `chunk`.
    /// @throws std::system_error, std::invalid_argument  as the other function.
    std::optional<Header> append(const Chunk& chunk, const timing::ClockReading& clock);

    /// Syncs all chunks to disk.
    ///
    /// It waits for the disk; the time is not limited.  Before the first begin_segment() it does
    /// nothing.
    /// @throws std::system_error  the unsynced chunks are kept; the next call writes them again.
    void sync();

    /// Returns the number of bytes written to all segments since construction.  Preambles, headers
    /// and chunks that were written again are included.
    [[nodiscard]] std::uint64_t bytes_written() const noexcept { return bytes_written_; }

private:
    void open_segment(const Header& header);
    void write(std::span<const std::byte> chunk);
    void give_up() noexcept;
    void rewrite_unsynced();
    void forget_unsynced();

    files::FileLayer& files_;
    std::filesystem::path directory_;
    std::optional<Header> header_;  ///< Header of begin_segment() or of the last rotation.
    std::optional<Header>
        unreported_header_;  ///< Header of a rotation that append() has to return.
    std::unique_ptr<files::AppendFile> segment_;
    std::uint64_t number_ = 0;  ///< Number of the newest segment.
    std::uint32_t next_sequence_ = 0;
    std::vector<std::byte> unsynced_;          ///< Bytes of the chunks; its memory is kept.
    std::uint32_t unsynced_count_ = 0;         ///< Number of these chunks.
    std::optional<RepeatedChunks> lost_from_;  ///< First place of unsynced_, if that sync failed.
    std::uint32_t first_unsynced_ = 1;         ///< First unsynced chunk of the open segment.
    timing::ClockReading newest_clock_, synced_clock_;
    std::uint64_t bytes_written_ = 0;
};

}  // namespace a351::journal
