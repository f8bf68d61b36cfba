#pragma once
/// @file
/// The cells of one line of a gravimeter, checked, with the first trouble that was found in them.
///
///     const Fields fields(layout, split_at_blanks(line));
///     if (!fields.trouble().empty()) return Refusal{fields.trouble()};
///     Reading reading = fields.reading();

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "corrector/gravimeter/columns.hpp"
#include "corrector/gravimeter/gravimeter_file.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector::gravimeter {

/// Returns the parts of a line between blanks and tabs; none is empty.
[[nodiscard]] std::vector<std::string_view> split_at_blanks(std::string_view line);
/// Returns the parts of a line between separators, without surrounding blanks; they can be empty.
[[nodiscard]] std::vector<std::string_view> split_at(std::string_view line, char separator);
/// Returns the text without blanks and tabs at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// A day: YYYY/MM/DD or YYYY-MM-DD, or with the year last MM/DD/YYYY.
struct Day {
    std::string iso;  ///< YYYY-MM-DD.
    bool has_year_last = false;
};
[[nodiscard]] std::optional<Day> parse_day(std::string_view text);

/// Cells of a line by the field that they fill.  The views must outlive the object.
///
/// Each cell is checked when the object is made.  A cell of dashes, of stars (a number too wide for
/// its column) or without text is not given, which is a trouble in a required column only.
class Fields {
public:
    Fields(const Layout& layout, const std::vector<std::string_view>& cells);

    /// Returns the first trouble in a few words; empty if there is none.
    [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }
    /// Returns a cell; empty if it is not given.
    [[nodiscard]] std::string_view text(std::string_view field) const;
    /// Returns a number in the unit of its field; absent if it is not given.
    [[nodiscard]] std::optional<double> number(std::string_view field) const;
    /// Returns the instant of the fields date and time; if there is none it is 1970 and a trouble.
    /// @param utc_minus_local  to be added to the time of the file.
    /// @param allows_month_first  true: MM/DD/YYYY is a date too.
    [[nodiscard]] UtcTime time(std::chrono::minutes utc_minus_local = {},
                               bool allows_month_first = false);

    /// Returns a reading with site, value, tide correction, dial, height, position and kept columns,
    /// as far as the line has them.  To be called without trouble.
    [[nodiscard]] Reading reading() const;

private:
    struct Cell {
        const Layout::Place* place = nullptr;
        std::string_view text;  ///< Empty: not given.
        std::optional<double> number;
    };

    void check(Cell& cell);
    void refuse(std::string_view name, std::string_view cell, std::string_view reason);
    [[nodiscard]] const Cell* find(std::string_view field) const;
    [[nodiscard]] std::optional<tide::Station> position(std::string_view prefix) const;

    std::vector<Cell> cells_;
    std::string trouble_;
};

}  // namespace a351::corrector::gravimeter
