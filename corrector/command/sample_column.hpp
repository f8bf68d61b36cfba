#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/text/csv_reader.hpp"

namespace a351::corrector {

/// The samples of one column of a CSV, a block at a time: a file of any length, or a pipe.
///
/// An empty cell is a missing sample.  Where the table has a column `time`, `time_utc` (RFC 3339)
/// or `time_s` (seconds), it must ascend in steps that are each within a quarter of the mean of
/// those before.
class SampleColumn {
public:
    /// @throws InputError  the file cannot be read, has no header or no such column.
    SampleColumn(const std::string& file, const std::string& column);

    /// Replaces `samples` by the next ones (NaN: missing). Returns false at the end.
    /// @throws InputError  a cell is not a number of at most 1e150, a time out of step; names the
    ///                     line.
    [[nodiscard]] bool read(std::vector<double>& samples);

    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] std::size_t missing_count() const noexcept { return missing_count_; }

    /// Bytes read so far, and size of the file (0 for a pipe).
    [[nodiscard]] std::size_t bytes_read();
    [[nodiscard]] std::size_t byte_count() const noexcept { return byte_count_; }

private:
    void check_time();

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

}  // namespace a351::corrector
