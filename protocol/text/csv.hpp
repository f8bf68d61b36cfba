#pragma once
/// @file
/// Comma-separated tables with a header line.  No quoting: a comma always separates.
/// Each error is an InputError `file:line: column = value: trouble; allowed: ...`.

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace a351::text {

class CsvTable {
public:
    /// Reads a table; line ends and blank lines are treated as in CsvReader.
    /// @param origin  file name shown in messages.
    /// @throws InputError  no header, a repeated column, a row of another width.
    [[nodiscard]] static CsvTable parse(std::string_view text, std::filesystem::path origin);

    [[nodiscard]] std::size_t row_count() const noexcept { return rows_.size(); }
    [[nodiscard]] bool has_column(std::string_view name) const;

    /// Returns a cell without surrounding blanks.
    /// @throws InputError  there is no such column; names the existing ones.
    [[nodiscard]] const std::string& cell(std::size_t row, std::string_view column) const;

    /// Returns the number in a cell: finite, a dot as decimal point, within [low, high].
    /// @throws InputError  the cell is not such a number.
    [[nodiscard]] double number(std::size_t row, std::string_view column,
                                double low = std::numeric_limits<double>::lowest(),
                                double high = std::numeric_limits<double>::max()) const;

    /// Returns number(), or std::nullopt for an empty cell.
    [[nodiscard]] std::optional<double> number_if_given(
        std::size_t row, std::string_view column,
        double low = std::numeric_limits<double>::lowest(),
        double high = std::numeric_limits<double>::max()) const;

    /// Throws the InputError about a cell, for rules that only the caller knows.
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
};

/// Reads the table in a file.
/// @throws InputError  as CsvTable::parse(), or the file cannot be read.
[[nodiscard]] CsvTable read_csv(const std::filesystem::path& file);

/// Returns the shortest decimal text that reads back as the same double (at most 17 digits).
[[nodiscard]] std::string shortest(double value);

}  // namespace a351::text
