#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "protocol/archive/miniseed.hpp"

namespace a351::archive {

/// The records of one channel in a file, from its begin.
///
///     RecordFile records(file, "BNZ");
///     while (const auto found = records.next()) use(found->record);
///
/// The file is read in pieces: memory for a whole day at 50 Hz costs more time than its records
/// need to be decoded.  It may grow or be replaced meanwhile; what it had at the start is read.
class RecordFile {
public:
    /// @throws std::filesystem::filesystem_error  there is no such file.
    RecordFile(std::filesystem::path file, std::string channel);

    /// Returns the size of the file at the start, bytes.
    [[nodiscard]] std::uint64_t size() const { return size_; }

    /// Returns the next record, with its offset in the file; std::nullopt: there is no other.
    /// @throws std::system_error  the file cannot be read.
    std::optional<FoundRecord> next();

    /// Returns the number of bytes between the record that next() returned, or the end of the file,
    /// and the record before it.
    [[nodiscard]] std::uint64_t skipped() const { return skipped_; }

    /// Returns bytes of the file.
    /// @throws std::system_error  they cannot be read.
    [[nodiscard]] std::vector<std::byte> bytes(std::uint64_t offset, std::uint64_t count);

    /// Returns the offset of the bytes that were skipped.
    [[nodiscard]] std::uint64_t skipped_at() const { return skipped_at_; }

private:
    std::filesystem::path file_;
    std::ifstream in_;
    std::string channel_;
    std::uint64_t size_;
    std::uint64_t read_to_ = 0;       ///< Offset up to which records are found.
    std::vector<FoundRecord> found_;  ///< Those of the last piece.
    std::size_t next_ = 0;            ///< The next one of them.
    std::uint64_t end_ = 0;           ///< End of the record that next() returned.
    std::uint64_t skipped_at_ = 0, skipped_ = 0;
};

}  // namespace a351::archive
