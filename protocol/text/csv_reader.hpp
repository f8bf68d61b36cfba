#pragma once
/// @file
/// Comma-separated tables, read row by row.  No quoting: a comma always separates.
/// Each error is an InputError `file:line: column = value: trouble; allowed: ...`.

#include <filesystem>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace a351::text {

/// Reads one row at a time.  Lines end with LF or CRLF; a byte-order mark and blank lines are
/// skipped.  In a table of one column a blank line is a row with an empty cell, except at the end
/// of the file.
class CsvReader {
public:
    /// Reads the header line.
    /// @param origin  file name shown in messages.
    /// @throws InputError  no header, a repeated column.
    CsvReader(std::istream& in, std::filesystem::path origin);

    [[nodiscard]] const std::vector<std::string>& columns() const noexcept { return columns_; }

    /// Reads the next row; returns false at the end.
    /// @throws InputError  the row has another width than the header, or the file cannot be read.
    [[nodiscard]] bool next();

    /// Returns the line number of the current row, counted from 1.
    [[nodiscard]] std::size_t line() const noexcept { return line_; }

    /// Returns the cells of the current row without surrounding blanks; valid until the next call
    /// of next().
    [[nodiscard]] const std::vector<std::string_view>& cells() const noexcept { return cells_; }

    /// Throws the InputError about a cell of the current row, for rules that only the caller knows.
    [[noreturn]] void refuse(std::size_t column, std::string_view trouble,
                             std::string_view allowed) const;

private:
    [[nodiscard]] bool next_line();

    std::istream& in_;
    std::filesystem::path origin_;
    std::vector<std::string> columns_;
    std::size_t line_ = 0;
    std::string text_;
    std::vector<std::string_view> cells_;
};

/// Returns the position of a column in the header of the table `origin`, counted from 0.
/// @throws InputError  there is no such column; names the existing ones.
[[nodiscard]] std::size_t column_index(const std::vector<std::string>& columns,
                                       std::string_view column,
                                       const std::filesystem::path& origin);

/// Returns a finite number written with a dot as decimal point; std::nullopt for any other text.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

}  // namespace a351::text
