#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/record/file_layer.hpp"
#include "protocol/record/journal.hpp"

namespace a351::record {

/// Why a segment ends before its file does.
struct JournalDamage {
    std::filesystem::path file;
    std::uint64_t offset = 0;      ///< First byte that belongs to no good chunk.
    std::uint64_t byte_count = 0;  ///< From there to the end of the file.
    std::string reason;
};

/// Reads one segment chunk by chunk with bounded memory.  Chunks of a type unknown here are passed
/// over; bytes that are no chunk end the segment.
class JournalReader {
public:
    /// @throws std::system_error  the file cannot be opened.
    explicit JournalReader(std::filesystem::path segment);

    /// The next good chunk; std::nullopt at the end or at the first damage.
    [[nodiscard]] std::optional<JournalChunk> next();

    /// Set once next() met damage.  A torn tail is normal: the writer may die at any byte.
    [[nodiscard]] const std::optional<JournalDamage>& damage() const noexcept { return damage_; }

private:
    [[nodiscard]] bool read(std::span<std::byte> bytes);
    std::optional<JournalChunk> stop(std::string reason);

    std::filesystem::path path_;
    std::ifstream in_;
    std::uint64_t size_ = 0;  ///< When the file was opened.
    std::vector<std::byte> payload_;
    std::uint64_t offset_ = 0;
    std::uint32_t next_sequence_ = 0;
    std::optional<JournalDamage> damage_;
};

/// The counter in the name of a segment, whatever was appended to the name; std::nullopt for others.
[[nodiscard]] std::optional<std::uint64_t> segment_number(const std::filesystem::path& file);

/// Segments of a directory by their counter; none when there is no such directory.
[[nodiscard]] std::vector<std::filesystem::path> journal_segments(
    const std::filesystem::path& directory);

/// Cuts a damaged tail of the newest segment into `*.torn` beside it.  A segment without a good
/// header is renamed so as a whole.
std::optional<JournalDamage> repair_newest_segment(FileLayer& files,
                                                   const std::filesystem::path& directory);

}  // namespace a351::record
