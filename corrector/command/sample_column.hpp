#pragma once
/// @file
/// Input of the commands that work on one column of a table.
///
///     SampleColumn column("in.csv", "acceleration_mgal");
///     std::vector<double> samples;
///     while (column.read(samples)) work(samples);
///
/// Samples have no times here, because all commands count them.  A time column is only checked, so
/// that a missing row does not shift the rest without notice.

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/text/csv_reader.hpp"

namespace a351::corrector::command {

/// The samples of one column of a CSV, a block at a time: a file of any length, or a pipe.
///
/// An empty cell is a missing sample.  If the table has a column `time`, `time_utc` (RFC 3339) or
/// `time_s` (seconds), it must ascend.  Each step must be within a quarter of the mean of the
/// earlier ones.
///
/// Memory is that of one block of 16 384 samples.  The first of `time`, `time_utc` and `time_s` in
/// the header is checked.  With it a missing row is refused: a missing sample needs a row with an
/// empty cell.  A table of one column may have blank lines as missing samples
/// (single_step_test.cpp).
class SampleColumn {
public:
    enum class Missing { allowed, refused };

    /// Opens the file and reads its header.
    /// @param file    path of the CSV, or of a pipe.
    /// @param column  name in the header.
    /// @param missing  refused: an empty cell is an InputError of read().
    /// @throws InputError  the file cannot be read, has no header or no such column.
    SampleColumn(const std::string& file, const std::string& column,
                 Missing missing = Missing::allowed);

    /// Replaces `samples` by the next ones (NaN: missing). Returns false at the end.
    /// @throws InputError  a cell is not a number of at most 1e150, a time out of step; names the
    ///                     line.
    [[nodiscard]] bool read(std::vector<double>& samples);

    /// Returns the number of samples read so far, missing ones included.
    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    /// Returns the number of missing samples among them.
    [[nodiscard]] std::size_t missing_count() const noexcept { return missing_count_; }

    /// Bytes read so far, and size of the file (0 for a pipe).
    [[nodiscard]] std::size_t bytes_read();
    [[nodiscard]] std::size_t byte_count() const noexcept { return byte_count_; }

private:
    void check_time();

    Missing missing_;
    std::ifstream in_;
    text::CsvReader reader_;
    std::size_t column_;
    std::optional<std::size_t> time_column_;
    std::optional<Nanoseconds> first_time_;
    std::optional<Nanoseconds> last_time_;
    std::int64_t step_count_ = 0;
    std::size_t count_ = 0;
    std::size_t missing_count_ = 0;
    std::size_t byte_count_ = 0;
};

}  // namespace a351::corrector::command
