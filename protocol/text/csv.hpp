#pragma once
/// @file
/// Tables of a spreadsheet with a header line: CSV, in any form that can be read in one way only.
/// Each error is an InputError `file:line: column = value: trouble; allowed: ...`.
///
/// Use CsvTable for short tables: it finds a cell by row and column name, and keeps the whole table
/// in memory.  Use CsvReader of csv_reader.hpp for long records.
///
///     const CsvTable table = read_csv(file);
///     for (std::size_t row = 0; row < table.row_count(); ++row) {
///         const double tide_mgal = table.number(row, "tide_mgal", -1.0, 1.0);
///         const std::string& site = table.cell(row, "site");
///         if (site.empty()) table.refuse(row, "site", "empty", "a name");
///     }
///
/// Columns may be in any order.  A column that no one asks for is not an error.  It shows no decimal
/// sign either, unless it is named with a unit, as altitude_m.

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/utc_time.hpp"
#include "protocol/text/decimal_sign.hpp"

namespace a351::text {

/// Table in memory, read by row number and column name.
///
/// Rows are counted from 0, without header and skipped lines.  Names of columns are case-sensitive.
/// Members that take a row throw std::out_of_range from row_count() on.  Each access to a cell
/// searches the header.  Any number of threads may read a table.
class CsvTable {
public:
    /// Reads a table as CsvReader does.  Empty rows are skipped, in a table of several columns.
    /// @param text    content of the file; it is copied.
    /// @param origin  file name shown in messages.
    /// @return a table that may have no rows: a header alone is valid.
    /// @throws InputError  no header, a repeated column, a row of another width, a form that
    ///                     cannot be read.
    [[nodiscard]] static CsvTable parse(std::string_view text, std::filesystem::path origin);

    /// Returns the number of rows, without the header.
    [[nodiscard]] std::size_t row_count() const noexcept { return rows_.size(); }
    /// Returns true if the header has the column.  Ask before reading a column that may be absent.
    [[nodiscard]] bool has_column(std::string_view name) const;

    /// Sign of the numbers of the table.
    [[nodiscard]] const DecimalSign& decimal_sign() const noexcept { return decimal_sign_; }

    /// Returns a cell as plain_text() without surrounding blanks.  The reference is valid until the table ends or
    /// is assigned to.
    /// @throws InputError  there is no such column; names the existing ones.
    [[nodiscard]] const std::string& cell(std::size_t row, std::string_view column) const;

    /// Returns the number in a cell: finite, within [low, high].
    /// @param low, high  limits, both allowed; without them every finite number is.
    /// @throws InputError  the cell is not such a number.  An empty cell is not a number.
    [[nodiscard]] double number(std::size_t row, std::string_view column,
                                double low = std::numeric_limits<double>::lowest(),
                                double high = std::numeric_limits<double>::max()) const;

    /// Returns number(), but not of a cell with an exponent whose last digit is worth more than
    /// `digit`: a spreadsheet has rounded it for its screen, as 979860.21 to 9.7986E+05.
    /// @throws InputError  also for such a cell.
    [[nodiscard]] double unrounded(std::size_t row, std::string_view column, double digit,
                                   double low, double high) const;

    /// Returns number(), or std::nullopt for an empty cell.
    /// @throws InputError  there is no such column, or the cell is neither empty nor such a number.
    [[nodiscard]] std::optional<double> number_if_given(
        std::size_t row, std::string_view column,
        double low = std::numeric_limits<double>::lowest(),
        double high = std::numeric_limits<double>::max()) const;

    /// Returns the instants of a column, which must ascend.
    /// @throws InputError  there is no such column, a cell is not an RFC 3339 time with zone, or it
    ///                     is not after the row before it.
    [[nodiscard]] std::vector<UtcTime> ascending_times(std::string_view column) const;

    /// Throws the InputError about a cell, for rules that only the caller knows.
    /// @param trouble  what is wrong, in a few words: "not an instant".
    /// @param allowed  what would be right: "YYYY-MM-DDThh:mm:ss with zone".
    /// @throws InputError  always; it is about the header if there is no such column.
    [[noreturn]] void refuse(std::size_t row, std::string_view column, std::string_view trouble,
                             std::string_view allowed) const;

private:
    struct Row {
        std::size_t line = 0;
        std::vector<std::string> cells;
    };

    std::filesystem::path origin_;
    std::vector<std::string> columns_;
    std::vector<Row> rows_;
    DecimalSign decimal_sign_;
};

/// Reads the table in a file.
/// @throws InputError  as CsvTable::parse(), or the file cannot be read.
[[nodiscard]] CsvTable read_csv(const std::filesystem::path& file);

/// Returns the shortest decimal text that reads back as the same double (at most 17 digits).
///
/// Use it for numbers in files.  Very large and very small numbers have an exponent, as in 1e-07.
/// parse_number() of csv_reader.hpp reads the text.  NaN gives "nan" and infinity "inf", which
/// parse_number() refuses: write an empty cell instead.
[[nodiscard]] std::string shortest(double value);

}  // namespace a351::text
