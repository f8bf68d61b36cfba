#pragma once
/// @file
/// Reads the journal: one segment, or all of them as one stream.  Repairs its end after a crash.
/// Format: protocol/journal/journal-format.md.
///
/// Use Sequence to read what was recorded:
///
///     Sequence chunks(segment_files(directory));
///     while (const auto chunk = chunks.next()) std::visit(handle, *chunk);
///     for (const Damage& damage : chunks.damage()) report(damage);
///
/// Use Reader for a single segment; there, chunks may occur that another segment repeats.
/// Before a Writer is made, call repair_newest_segment().  Readers never change a file.
///
/// Damage is a value, not an exception, because a writer may die at any byte.  Only a file that
/// cannot be opened is an exception.

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
#include "protocol/journal/journal_codec.hpp"

namespace a351::journal {

/// Bytes of a segment that are not a good chunk; their chunks are lost.
///
/// In a compressed segment the positions count its bytes before compression.  If it cannot be
/// unpacked at all, `offset` is 0 and `byte_count` is the size of the compressed file.
struct Damage {
    std::filesystem::path file;
    std::uint64_t offset = 0;  ///< First byte after the last good chunk.
    std::uint64_t byte_count =
        0;  ///< From there to the next good chunk, or to the end of the file.
    /// Reason as text, "wrong checksum" or "torn chunk" for example, without file and position.
    std::string reason;
    /// Sequence number of the next good chunk; absent if the damage extends to the end.
    std::optional<std::uint32_t> next_sequence{};
};

/// Reads one segment, compressed or not, chunk by chunk with bounded memory.  Chunks of an unknown
/// type are skipped.  After bytes that are not a good chunk, reading continues with the next one:
/// the next place where length, type and checksum fit and the sequence number is larger.
///
/// An uncompressed segment needs the memory of a chunk and of the search for one, 128 KiB.  A
/// compressed one is unpacked as a whole, at most 65 MiB, in the constructor.
///
/// A segment that is still being written is read up to its size at construction.  Its last chunk
/// may then be reported as torn; make a new reader later.
///
/// One flipped bit in any byte of a segment is detected, and costs one chunk, unless it is in the
/// header.  A tail torn at any byte costs only the chunks from there on.  journal_reader_test.cpp
/// shows both.
class Reader {
public:
    /// Opens a segment; `.zst` at the end of the name means that it is compressed.  Nothing is
    /// decoded before next().
    /// @throws std::system_error  the file cannot be opened.  A compressed file that exists but
    ///         cannot be read or unpacked does not throw: it is damage.
    explicit Reader(std::filesystem::path segment);

    /// Returns the next good chunk; std::nullopt at the end.
    ///
    /// The first chunk is always the Header, and no later one is.  After std::nullopt every
    /// call returns std::nullopt.
    [[nodiscard]] std::optional<Chunk> next();

    /// Returns the sequence number of the last chunk that next() returned.  It has no meaning
    /// before the first chunk and after std::nullopt.  The header has 0; a skipped or lost chunk
    /// leaves a gap.
    [[nodiscard]] std::uint32_t sequence() const noexcept { return sequence_; }

    /// Returns the position after the last good chunk that next() found; 0 before the header.
    [[nodiscard]] std::uint64_t end() const noexcept { return offset_; }

    /// Returns the damage that next() found so far.  A torn tail is normal: the writer may die at
    /// any byte.  Without a good header the whole file is damage, and `offset` is 0.
    [[nodiscard]] const std::vector<Damage>& damage() const noexcept { return damage_; }

private:
    /// The bytes at a place of the segment, taken for a chunk.
    struct Look {
        ChunkHeader header;
        std::optional<Chunk> chunk;     ///< Absent for a type that is unknown.
        const char* trouble = nullptr;  ///< Null if they are a good chunk.
    };
    /// A good chunk found by search.
    struct Place {
        std::uint64_t offset = 0;
        std::uint32_t sequence = 0;
    };

    [[nodiscard]] bool read(std::uint64_t at, std::span<std::byte> bytes);
    [[nodiscard]] Look look_at(std::uint64_t at);
    [[nodiscard]] std::optional<Place> search(std::uint64_t from);
    std::optional<Chunk> refuse(std::string reason);

    std::filesystem::path path_;
    std::unique_ptr<std::istream> in_;
    std::uint64_t size_ = 0;      ///< Size when the file was opened.
    std::uint64_t position_ = 0;  ///< Place of the next byte of `in_`.
    std::vector<std::byte> payload_;
    std::uint64_t offset_ = 0;  ///< End of the last good chunk; 0 before the header.
    std::uint32_t next_sequence_ = 0;
    std::uint32_t sequence_ = 0;
    bool is_over_ = false;
    std::vector<Damage> damage_;
};

/// Returns true if a chunk that the damage may have cost is repeated by the next segment.  The rest
/// of the damaged segment must then not be read, because the next one has all of it, in order.
/// @param header  of the damaged segment.
/// @param next    of the first readable segment after it.
[[nodiscard]] bool is_repeated_later(const Damage& damage, const Header& header,
                                     const Header& next);

/// Recognises chunks that were read before.  A segment whose header has `repeats` begins with the
/// chunks that followed the last good sync of an earlier segment, because the disk may have lost
/// them there.  Some or all of them may still exist there, or in further attempts between the two.
///
/// Segments must be read in order, each to its end, or to damage that is_repeated_later().
///
/// Sequence uses it.  A program needs it only if it reads the segments by itself:
///
///     while (const auto chunk = reader.next())
///         if (!repetitions.is_repeated(number, reader.sequence(), *chunk)) use(*chunk);
///
/// Keep one object for all segments, and call it for every chunk, headers included.  If reading
/// begins at a segment that repeats chunks, none of them is skipped.
class Repetitions {
public:
    /// Returns true if the chunk was read before and must be skipped.  Headers are never repeated.
    /// @param segment   number of the segment.
    /// @param sequence  sequence number of the chunk within it.
    [[nodiscard]] bool is_repeated(std::uint64_t segment, std::uint32_t sequence,
                                   const Chunk& chunk);

private:
    std::optional<RepeatedChunks> from_;  ///< First place of the repeated chunks.
    std::uint32_t chunks_read_ = 0;       ///< Number of these that were read.
    std::uint32_t to_skip_ = 0;           ///< Number of chunks to skip in this segment.
    std::uint64_t last_segment_ = 0;
    std::uint32_t last_sequence_ = 0;
};

/// Reads segments one after the other, each chunk once: repeated chunks are skipped.
///
/// Every segment begins with its Header.  If its `session` is that of the header before, the
/// stream continues.  Damage costs the chunks in it; reading continues with the next good chunk.
class Sequence {
public:
    /// Opens no file; next() opens them one by one.
    /// @param segments  result of segment_files(), or the last of these.
    explicit Sequence(std::vector<std::filesystem::path> segments);

    /// Returns the next chunk; std::nullopt at the end.
    /// @throws std::system_error  a segment cannot be opened, for example because it was compressed
    ///         or removed after it was listed.  The next call continues with the segment after it.
    [[nodiscard]] std::optional<Chunk> next();

    /// Returns the damage found in the segments read so far, in their order.
    [[nodiscard]] const std::vector<Damage>& damage() const noexcept { return damage_; }

private:
    void open_next();
    [[nodiscard]] bool is_repeated_later();

    std::vector<std::filesystem::path> segments_;
    std::size_t next_segment_ = 0;
    std::uint64_t number_ = 0;
    std::optional<Reader> reader_;
    std::size_t damage_in_segment_ = 0;  ///< Entries of the reader's damage that were examined.
    std::optional<Header> header_;       ///< Header of the segment.
    /// Header of the next segment that has one; read at the first damage only.
    std::optional<std::optional<Header>> next_header_;
    Repetitions repetitions_;
    std::vector<Damage> damage_;
};

/// Returns the header of a segment; std::nullopt if it is damaged.
///
/// An uncompressed segment is read only as far as its header.  A compressed one is unpacked as a
/// whole.
/// @throws std::system_error  the file cannot be opened.
[[nodiscard]] std::optional<Header> segment_header(const std::filesystem::path& segment);

/// Returns the newest MARK of a segment, if there is one.
///
/// The whole segment is read.  Samples up to a mark are in the archive and synced; those of earlier
/// sessions are too.
/// @throws std::system_error  the file cannot be opened.
[[nodiscard]] std::optional<MarkChunk> newest_mark(const std::filesystem::path& segment);

/// Returns the host's UTC when the segment began, from the file name.  It is only a hint, but the
/// file need not be read.
///
/// The host's clock may have been wrong, so never order segments by it.  Resolution: 1 s.
/// @return std::nullopt if the name has no time after its first underscore.
[[nodiscard]] std::optional<UtcTime> segment_time(const std::filesystem::path& file);

/// Returns the counter in the name of a segment; a suffix of the name is ignored.  std::nullopt for
/// other files.
///
/// Names of compressed, partial and torn segments have it too.  The file need not exist.  A counter
/// has 8 to 18 digits.
[[nodiscard]] std::optional<std::uint64_t> segment_number(const std::filesystem::path& file);

/// Returns the segments of a directory, compressed or not, in the order of their counter; none if
/// the directory does not exist.
///
/// If a segment exists in both forms, its original is listed.  Partial and torn files are not.
/// Segments with damage are listed, because no file is opened.  Directories below are not searched.
/// @throws std::system_error  the directory cannot be listed.
[[nodiscard]] std::vector<std::filesystem::path> segment_files(
    const std::filesystem::path& directory);

/// Numbers of segments that a journal lacks between two others.
struct AbsentSegments {
    std::uint64_t first = 0, last = 0;
    std::filesystem::path before, after;  ///< The files beside them.
};

/// Returns the segments that are not there, not even as a torn one: they were removed or not copied,
/// or the disk failed when they began.  The daemon removes old segments from the first on, so none
/// is missing before the oldest.
/// @throws std::system_error  the directory cannot be listed.
[[nodiscard]] std::vector<AbsentSegments> absent_segments(const std::filesystem::path& directory);

/// Moves a damaged tail of the newest segment to a file `*.torn` beside it and syncs the rest.  A
/// segment without a good header is renamed to `*.torn` as a whole.
///
/// Call it at start, while no writer is open.  The tail is synced in its new file before it is cut,
/// so a crash in between loses nothing.  An older `*.torn` of the same segment is replaced.
///
/// If its end is not damaged, the segment is only synced.  A compressed segment is left as it is.
/// Damage with good chunks after it is left too, and so is damage in older segments; readers
/// continue after it.  Each call treats one segment: after it was renamed as a whole, a further
/// call examines the one before it.
///
/// @return the damaged end, if there was one.  Positions are those before the repair.
/// @throws std::system_error  a file cannot be read or written; call it again.
std::optional<Damage> repair_newest_segment(files::FileLayer& files,
                                            const std::filesystem::path& directory);

}  // namespace a351::journal
