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
#include "protocol/journal/journal_repetitions.hpp"

namespace a351::record {

/// Why a segment ends before its file does.
struct JournalDamage {
    std::filesystem::path file;
    std::uint64_t offset = 0;      ///< First byte that belongs to no good chunk.
    std::uint64_t byte_count = 0;  ///< From there to the end of the file.
    std::string reason;
};

/// Reads one segment, compressed or not, chunk by chunk with bounded memory.  Chunks of a type unknown here are passed
/// over; bytes that are no chunk end the segment.
class JournalReader {
public:
    /// @throws std::system_error  the file cannot be opened.
    explicit JournalReader(std::filesystem::path segment);

    /// The next good chunk; std::nullopt at the end or at the first damage.
    [[nodiscard]] std::optional<JournalChunk> next();

    /// Of the chunk that next() gave last.
    [[nodiscard]] std::uint32_t sequence() const noexcept { return sequence_; }

    /// Set once next() met damage.  A torn tail is normal: the writer may die at any byte.
    [[nodiscard]] const std::optional<JournalDamage>& damage() const noexcept { return damage_; }

private:
    [[nodiscard]] bool read(std::span<std::byte> bytes);
    std::optional<JournalChunk> stop(std::string reason);

    std::filesystem::path path_;
    std::unique_ptr<std::istream> in_;
    std::uint64_t size_ = 0;  ///< When the file was opened.
    std::vector<std::byte> payload_;
    std::uint64_t offset_ = 0;
    std::uint32_t next_sequence_ = 0;
    std::uint32_t sequence_ = 0;
    std::optional<JournalDamage> damage_;
};

/// Reads segments one after the other, each chunk once: repeated ones are passed over.
class JournalSequence {
public:
    /// @param segments  as journal_segments() gives them, or the last of these.
    explicit JournalSequence(std::vector<std::filesystem::path> segments);

    [[nodiscard]] std::optional<JournalChunk> next();

    /// Of the segments read so far.
    [[nodiscard]] const std::vector<JournalDamage>& damage() const noexcept { return damage_; }

private:
    std::vector<std::filesystem::path> segments_;
    std::size_t next_segment_ = 0;
    std::uint64_t number_ = 0;
    std::optional<JournalReader> reader_;
    Repetitions repetitions_;
    std::vector<JournalDamage> damage_;
};

/// What heads a segment; std::nullopt when nothing in it can be read.
[[nodiscard]] std::optional<JournalHeader> segment_header(const std::filesystem::path& segment);

/// The newest MARK of a segment, if there is one.
[[nodiscard]] std::optional<MarkChunk> newest_mark(const std::filesystem::path& segment);

/// When the host thought a segment began, from its name: a hint that costs no reading.
[[nodiscard]] std::optional<UtcTime> segment_time(const std::filesystem::path& file);

/// The counter in the name of a segment, whatever was appended to the name; std::nullopt for others.
[[nodiscard]] std::optional<std::uint64_t> segment_number(const std::filesystem::path& file);

/// Segments of a directory, compressed or not, by their counter; none when there is no such directory.
[[nodiscard]] std::vector<std::filesystem::path> journal_segments(
    const std::filesystem::path& directory);

/// Cuts a damaged tail of the newest segment into `*.torn` beside it, and syncs what is left.  A
/// segment without a good header is renamed so as a whole.
std::optional<JournalDamage> repair_newest_segment(FileLayer& files,
                                                   const std::filesystem::path& directory);

}  // namespace a351::record
