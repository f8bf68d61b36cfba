#pragma once
/// @file
/// Comma-separated tables a row at a time.  No quoting: a comma always separates.
/// Each error is an InputError `file:line: column = value: trouble; allowed: ...`.

#include <filesystem>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace a351::text {

/// Line ends LF or CRLF; a byte-order mark and blank lines are skipped.  In a table of one column a
/// blank line is a row with an empty cell, but for one that ends the file.
class CsvReader {
public:
    /// Reads the header line.
    /// @throws InputError  no header, a repeated column.
    CsvReader(std::istream& in, std::filesystem::path origin);

    [[nodiscard]] const std::vector<std::string>& columns() const noexcept { return columns_; }

    /// Goes to the next row; false at the end.
    /// @throws InputError  a row of another width, a file that cannot be read on.
    [[nodiscard]] bool next();

    /// Of the current row, counted from 1.
    [[nodiscard]] std::size_t line() const noexcept { return line_; }

    /// The current row's cells without surrounding blanks; until the next call of next().
    [[nodiscard]] const std::vector<std::string_view>& cells() const noexcept { return cells_; }

    [[noreturn]] void refuse(std::size_t column, std::string_view trouble,
                             std::string_view allowed) const;

private:
    [[nodiscard]] bool next_line();
    [[nodiscard]] bool is_row(std::string_view content);

    std::istream& in_;
    std::filesystem::path origin_;
    std::vector<std::string> columns_;
    std::size_t line_ = 0;
    std::string text_;
    std::vector<std::string_view> cells_;
};

/// Place of a column in the header of the table `origin`.
/// @throws InputError  no such column; names those that are there.
[[nodiscard]] std::size_t column_index(const std::vector<std::string>& columns,
                                       std::string_view column,
                                       const std::filesystem::path& origin);

/// A finite number with a dot as decimal point; std::nullopt for any other text.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

}  // namespace a351::text
