#pragma once
/// @file
/// Comma-separated tables, read row by row.  No quoting: a comma always separates.
/// Each error is an InputError `file:line: column = value: trouble; allowed: ...`.
///
/// Use CsvReader for long records: it keeps one line in memory.  For short tables CsvTable of
/// csv.hpp is easier, because it finds cells by name and checks numbers.
///
///     std::ifstream in = open_file(file);
///     CsvReader reader(in, file);
///     const std::size_t column = column_index(reader.columns(), "tide_mgal", file);
///     while (reader.next()) {
///         const std::optional<double> tide_mgal = parse_number(reader.cells()[column]);
///         if (!tide_mgal) reader.refuse(column, "not a number", "a finite number");
///     }

#include <filesystem>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/utc_time.hpp"

namespace a351::text {

/// Reads one row at a time.  Lines end with LF or CRLF; a byte-order mark and blank lines are
/// skipped.  In a table of one column a blank line is a row with an empty cell, except at the end
/// of the file.
///
/// Quotation marks are part of the cell.  Do not copy a reader: both would take lines from the same
/// stream, and cells() of the copy refer to the line of the original.
class CsvReader {
public:
    /// Reads the header line.  Blank lines before it are skipped.
    /// @param in      stream at the beginning of the table; it must outlive the reader.
    /// @param origin  file name shown in messages.
    /// @throws InputError  no header, a repeated column.
    CsvReader(std::istream& in, std::filesystem::path origin);

    /// Returns the names in the header, in order, without surrounding blanks.  Use column_index()
    /// to find one.
    [[nodiscard]] const std::vector<std::string>& columns() const noexcept { return columns_; }

    /// Reads the next row; returns false at the end.
    /// @throws InputError  the row has another width than the header, or the file cannot be read.
    [[nodiscard]] bool next();

    /// Returns the line number of the current row, counted from 1.  Blank lines and the header
    /// count.
    [[nodiscard]] std::size_t line() const noexcept { return line_; }

    /// Returns the cells of the current row without surrounding blanks; valid until the next call
    /// of next().  Call it only after next() has returned true: there are then as many cells as
    /// columns.
    [[nodiscard]] const std::vector<std::string_view>& cells() const noexcept { return cells_; }

    /// Returns the instant in a cell of the current row: RFC 3339 with zone, or seconds since 1970,
    /// below 9e9 in magnitude.
    /// @throws InputError  the cell is neither.
    [[nodiscard]] UtcTime instant(std::size_t column) const;

    /// Returns the number in a cell of the current row; NaN for an empty cell, a missing sample.
    /// @param largest  greatest magnitude.
    /// @throws InputError  the cell is neither empty nor such a number.
    [[nodiscard]] double sample(std::size_t column, double largest) const;

    /// Throws the InputError about a cell of the current row, for rules that only the caller knows.
    /// @param column   position of the column, from 0.
    /// @param trouble  what is wrong, in a few words: "not a time".
    /// @param allowed  what would be right: "an instant (RFC 3339), or seconds".
    /// @throws std::out_of_range  there is no such column.
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

/// Returns the position of a column in the header of the table `origin`, counted from 0.  Call it
/// once, before the loop over the rows: it compares every name in turn.
/// @throws InputError  there is no such column; names the existing ones.
[[nodiscard]] std::size_t column_index(const std::vector<std::string>& columns,
                                       std::string_view column,
                                       const std::filesystem::path& origin);

/// Returns a finite number written with a dot as decimal point; std::nullopt for any other text.
///
/// The whole text must be the number: `-1.5` and `2e-3` are numbers in every locale.  An empty
/// text, a number between blanks, `+1`, `nan`, `inf`, `0x10` and `1e400` are not.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

}  // namespace a351::text
