#pragma once
/// @file
/// The lines of a table as spreadsheets write it, split into cells.  CsvReader gives them names.
///
/// UTF-8, or UTF-16 with a byte-order mark.  Cells are separated by commas, semicolons or tabs: the
/// header, or a line `sep=;` before it, decides.  Cells may be in quotation marks (RFC 4180).  Each
/// cell is returned as plain_text() without surrounding blanks.

#include <deque>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

namespace a351::text {

/// Remedy that ends refusals of a table that can be read in two ways, or in none.  With a decimal
/// comma Excel writes semicolons also as CSV UTF-8.
inline constexpr std::string_view kHowToSave =
    "; in a spreadsheet: set the decimal sign to a point, and save as CSV UTF-8, separated by "
    "commas";

class CsvLines {
public:
    explicit CsvLines(std::istream& in);

    /// Reads the next line that is not blank into cells().  In a table of one column, ask for blank
    /// lines too: they are missing cells.
    /// @return false at the end, or if trouble() is not empty.
    [[nodiscard]] bool next(bool with_blank_lines);

    /// Returns why the table cannot be read, and what is allowed; empty if it can.
    [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }

    /// Returns true after an error of the stream.
    [[nodiscard]] bool is_broken() const { return in_.bad(); }

    /// Cells of the line; valid until the next call of next().
    [[nodiscard]] const std::vector<std::string_view>& cells() const noexcept { return cells_; }
    /// The line as it was read, in UTF-8.
    [[nodiscard]] std::string_view text() const noexcept { return text_; }
    /// Number of the line, from 1; that of its beginning if a quoted cell has line breaks.
    [[nodiscard]] std::size_t line() const noexcept { return line_; }
    [[nodiscard]] char separator() const noexcept { return separator_; }
    [[nodiscard]] bool is_utf16() const noexcept { return encoding_ != Encoding::utf8; }

private:
    enum class Encoding { utf8, utf16_little, utf16_big };

    [[nodiscard]] bool read_line(std::string& line);
    [[nodiscard]] bool read_utf16_line(std::string& line);
    [[nodiscard]] bool choose_separator();
    [[nodiscard]] bool split();
    [[nodiscard]] bool take_quoted(std::size_t& at);
    void take(std::string_view cell);

    std::istream& in_;
    Encoding encoding_ = Encoding::utf8;
    char separator_ = '\0';  ///< '\0' before the header.
    std::size_t line_ = 0, lines_read_ = 0;
    std::string text_;
    std::string trouble_;
    std::vector<std::string_view> cells_;
    std::deque<std::string> changed_;  ///< Cells that differ from the text of the line.
};

}  // namespace a351::text
