#pragma once
/// @file
/// Tables of a spreadsheet, read row by row: CSV, in any form that can be read in one way only.
/// Each error is an InputError `file:line: column = value: trouble; allowed: ...`.
///
/// Use CsvReader for long records: it keeps one line in memory.  For short tables CsvTable of
/// csv.hpp is easier, because it finds cells by name and checks numbers.
///
///     std::ifstream in = open_file(file);
///     CsvReader reader(in, file);
///     const std::size_t column = column_index(reader.columns(), "tide_mgal", file);
///     while (reader.next()) {
///         const std::optional<double> tide_mgal = reader.number(column);
///         if (!tide_mgal) reader.refuse(column, "not a number", "a finite number");
///     }

#include <filesystem>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/text/csv_lines.hpp"
#include "protocol/text/decimal_sign.hpp"

namespace a351::text {

/// Reads one row at a time.  Lines end with LF or CRLF; a byte-order mark and blank lines are
/// skipped.  In a table of one column a blank line is a row with an empty cell.  Empty rows at the
/// end of the file and empty cells after the last column are skipped.
///
/// CsvLines splits the lines, DecimalSign reads the numbers.  A form that can be read in two ways
/// is refused, with the remedy in the spreadsheet.  Do not copy a reader: both would take lines
/// from the same stream, and cells() of the copy refer to the line of the original.
class CsvReader {
public:
    /// Reads the header line.  Blank lines before it are skipped.
    /// @param in      stream at the beginning of the table; it must outlive the reader.
    /// @param origin  file name shown in messages.
    /// @throws InputError  no header, a repeated column, a form that cannot be read.
    CsvReader(std::istream& in, std::filesystem::path origin);

    /// Returns the names in the header, in order, without surrounding blanks.  Use column_index()
    /// to find one.
    [[nodiscard]] const std::vector<std::string>& columns() const noexcept { return columns_; }

    /// Takes a column as one of numbers, from the next row on: its numbers show the decimal sign of
    /// the table.  Columns that are named with a unit, as altitude_m, are such columns already.
    void expect_numbers(std::size_t column) { is_number_.at(column) = true; }

    /// Reads the next row; returns false at the end.
    /// @throws InputError  the row has another width than the header, or the file cannot be read.
    [[nodiscard]] bool next();

    /// Returns the line number of the current row, counted from 1.  Blank lines and the header
    /// count.
    [[nodiscard]] std::size_t line() const noexcept { return line_; }

    /// Returns the cells of the current row as plain_text() without surrounding blanks; valid until
    /// the next call of next().  Call it only after next() has returned true: there are then as many cells as
    /// columns.
    [[nodiscard]] const std::vector<std::string_view>& cells() const noexcept { return cells_; }

    /// Returns the finite number in a cell of the current row; std::nullopt for any other text.
    [[nodiscard]] std::optional<double> number(std::size_t column) const {
        return decimal_sign_.number(cells_[column]);
    }

    /// Sign of the numbers so far, and separator of the cells.
    [[nodiscard]] const DecimalSign& decimal_sign() const noexcept { return decimal_sign_; }
    [[nodiscard]] char separator() const noexcept { return lines_.separator(); }
    /// Returns true for UTF-16, in which no line can be added by appending UTF-8.
    [[nodiscard]] bool is_utf16() const noexcept { return lines_.is_utf16(); }

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
    void check_width() const;
    void note_decimal_signs();
    [[noreturn]] void refuse_line(std::string_view trouble) const;

    CsvLines lines_;
    std::filesystem::path origin_;
    std::vector<std::string> columns_;
    std::vector<bool> is_number_;  ///< For each column.
    DecimalSign decimal_sign_;
    std::size_t line_;
    std::vector<std::string_view> cells_;
    std::size_t empty_rows_ = 0;  ///< Empty rows that come before the line that was read.
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
