#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/files/file_layer.hpp"
#include "protocol/journal/journal.hpp"

namespace a351::record {

/// Damage that ends a segment before its file ends.
struct JournalDamage {
    std::filesystem::path file;
    std::uint64_t offset = 0;      ///< First byte after the last good chunk.
    std::uint64_t byte_count = 0;  ///< From there to the end of the file.
    std::string reason;
};

/// Reads one segment, compressed or not, chunk by chunk with bounded memory.  Chunks of an unknown
/// type are skipped; bytes that are not a chunk end the segment.
class JournalReader {
public:
    /// @throws std::system_error  the file cannot be opened.
    explicit JournalReader(std::filesystem::path segment);

    /// Returns the next good chunk; std::nullopt at the end or at the first damage.
    [[nodiscard]] std::optional<JournalChunk> next();

    /// Returns the sequence number of the last chunk that next() returned.
    [[nodiscard]] std::uint32_t sequence() const noexcept { return sequence_; }

    /// Returns the damage that next() found.  A torn tail is normal: the writer may die at any
    /// byte.
    [[nodiscard]] const std::optional<JournalDamage>& damage() const noexcept { return damage_; }

private:
    [[nodiscard]] bool read(std::span<std::byte> bytes);
    std::optional<JournalChunk> stop(std::string reason);

    std::filesystem::path path_;
    std::unique_ptr<std::istream> in_;
    std::uint64_t size_ = 0;  ///< Size when the file was opened.
    std::vector<std::byte> payload_;
    std::uint64_t offset_ = 0;
    std::uint32_t next_sequence_ = 0;
    std::uint32_t sequence_ = 0;
    std::optional<JournalDamage> damage_;
};

/// Recognises chunks that were read before.  A segment whose header has `repeats` begins with the
/// chunks that followed the last good sync of an earlier segment, because the disk may have lost
/// them there.  Some or all of them may still exist there, or in further attempts between the two.
///
/// Segments must be read in order, each to its end or its first damage.
class Repetitions {
public:
    /// Returns true if the chunk was read before and must be skipped.
    /// @param segment   number of the segment.
    /// @param sequence  sequence number of the chunk within it.
    [[nodiscard]] bool is_repeated(std::uint64_t segment, std::uint32_t sequence,
                                   const JournalChunk& chunk);

private:
    std::optional<RepeatedChunks> from_;  ///< First place of the repeated chunks.
    std::uint32_t chunks_read_ = 0;       ///< Number of these that were read.
    std::uint32_t to_skip_ = 0;           ///< Number of chunks to skip in this segment.
    std::uint64_t last_segment_ = 0;
    std::uint32_t last_sequence_ = 0;
};

/// Reads segments one after the other, each chunk once: repeated chunks are skipped.
class JournalSequence {
public:
    /// @param segments  result of journal_segments(), or the last of these.
    explicit JournalSequence(std::vector<std::filesystem::path> segments);

    /// Returns the next chunk; std::nullopt at the end.
    [[nodiscard]] std::optional<JournalChunk> next();

    /// Returns the damage found in the segments read so far.
    [[nodiscard]] const std::vector<JournalDamage>& damage() const noexcept { return damage_; }

private:
    std::vector<std::filesystem::path> segments_;
    std::size_t next_segment_ = 0;
    std::uint64_t number_ = 0;
    std::optional<JournalReader> reader_;
    Repetitions repetitions_;
    std::vector<JournalDamage> damage_;
};

/// Returns the header of a segment; std::nullopt if it cannot be read.
[[nodiscard]] std::optional<JournalHeader> segment_header(const std::filesystem::path& segment);

/// Returns the newest MARK of a segment, if there is one.
[[nodiscard]] std::optional<MarkChunk> newest_mark(const std::filesystem::path& segment);

/// Returns the host's UTC when the segment began, from the file name.  It is only a hint, but the
/// file need not be read.
[[nodiscard]] std::optional<UtcTime> segment_time(const std::filesystem::path& file);

/// Returns the counter in the name of a segment; a suffix of the name is ignored.  std::nullopt for
/// other files.
[[nodiscard]] std::optional<std::uint64_t> segment_number(const std::filesystem::path& file);

/// Returns the segments of a directory, compressed or not, in the order of their counter; none if
/// the directory does not exist.
[[nodiscard]] std::vector<std::filesystem::path> journal_segments(
    const std::filesystem::path& directory);

/// Moves a damaged tail of the newest segment to a file `*.torn` beside it and syncs the rest.  A
/// segment without a good header is renamed to `*.torn` as a whole.
/// @return the damage, if there was any.
std::optional<JournalDamage> repair_newest_segment(FileLayer& files,
                                                   const std::filesystem::path& directory);

}  // namespace a351::record
