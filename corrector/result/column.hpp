#pragma once
/// @file
/// Columns of a table, declared once and written as CSV, as JSON and as a table for people.
///
/// A column has a key, a function from a row to a cell, and its appearance for people.  A list of
/// columns describes a whole table, so that all three forms agree:
///
///     const std::vector<Column<Station>> columns{
///         {"site", [](const Station& s) { return s.site; }, {"Station", 0, 'n'}},
///         {"gravity_mgal", [](const Station& s) { return cell(s.gravity); }, {"Gravity mGal"}},
///     };
///     const std::string csv = csv_table(columns, stations);
///     const std::string text = aligned_text(table_of(columns, stations));
///
/// The order of the columns is that of the list in every form.  Texts are not escaped here.  In CSV
/// they must contain neither comma nor line end.
///
/// No function reads a clock, a locale or a file.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "corrector/result/table.hpp"
#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector::result {

/// Value of a cell; std::monostate if the row has none.
///
/// A double should be finite.  NaN is not an empty cell: it is "nan" or "-nan" in CSV and in tables
/// for people.  In JSON it becomes null when the JSON is written.
using Cell = std::variant<std::monostate, bool, std::int64_t, double, std::string, UtcTime>;

/// Returns the value as a cell; without a value an empty cell.  Quantities become numbers in their
/// own unit, and a number of things is written without decimals.
[[nodiscard]] inline Cell cell(double value) { return value; }
[[nodiscard]] inline Cell cell(bool is_so) { return is_so; }
[[nodiscard]] inline Cell cell(int number) { return std::int64_t{number}; }
[[nodiscard]] inline Cell cell(std::size_t count) { return static_cast<std::int64_t>(count); }
[[nodiscard]] inline Cell cell(const std::string& text) { return text; }
[[nodiscard]] inline Cell cell(UtcTime time) { return time; }
template <class Unit>
[[nodiscard]] Cell cell(Quantity<Unit> value) {
    return value.value();
}
template <class Value>
[[nodiscard]] Cell cell(const std::optional<Value>& value) {
    return value ? cell(*value) : Cell();
}

/// Returns a function that gives a member of a row as its cell.
template <class Row, class Value>
[[nodiscard]] std::function<Cell(const Row&)> of(Value Row::*member) {
    return [member](const Row& row) { return cell(row.*member); };
}

/// Returns a function that gives a member of a part of a row as its cell, for example of a reading.
/// @param part  a member of the row: a value, or an optional or a pointer, without which the cell is
///              empty.
template <class Row, class Holder, class Part, class Value>
[[nodiscard]] std::function<Cell(const Row&)> of(Holder Row::*part, Value Part::*member) {
    return [part, member](const Row& row) {
        if constexpr (std::is_base_of_v<Part, Holder>)
            return cell((row.*part).*member);
        else
            return row.*part ? cell((*(row.*part)).*member) : Cell();
    };
}

/// How people see a column.  A default-constructed one hides it from them.
struct Shown {
    std::string_view heading;  ///< Empty: the column is in CSV and JSON only.
    int decimals = 3;          ///< Decimals of a number.
    char alignment = 'r';      ///< l left, n left without line breaks, r right (numbers).
};

/// One column of a table.
///
/// Invariants of a list of columns: keys are different, and `value` is not empty.  `key` and the
/// heading are views, so the texts must outlive the column; literals do.
/// @tparam Row  type of a row; `value` is called once or twice per row and form.
template <class Row>
struct Column {
    std::string_view key;  ///< Name in CSV and JSON, with the unit.
    /// Function that returns the cell of a row.
    std::function<Cell(const Row&)> value;
    /// Heading and format for people; by default the column is in CSV and JSON only.
    Shown shown = {};
};

/// Returns a cell as CSV: numbers with six decimals, true and false as 1 and 0, instants in RFC
/// 3339 to the millisecond, empty without a value.
///
/// A number never has an exponent, and zero has no sign.  An instant is truncated to the past.
[[nodiscard]] std::string csv_text(const Cell& cell);

/// Returns a cell for people: yes or no, instants to the second, "-" without a value.
/// @param decimals  0 to 80, digits after the point of a double; other cells do not use it.
[[nodiscard]] std::string shown_text(const Cell& cell, int decimals);

/// Returns a cell as JSON: numbers in full, instants as in CSV, null without a value.  A bool is
/// true or false, and a count is a whole number.
[[nodiscard]] nlohmann::ordered_json json_value(const Cell& cell);

/// Returns the header line of a CSV file: the keys, with a line end.
template <class Row>
[[nodiscard]] std::string csv_header(const std::vector<Column<Row>>& columns) {
    std::string line;
    for (const Column<Row>& column : columns) (line += line.empty() ? "" : ",") += column.key;
    return line + '\n';
}

/// Returns a line of a CSV file, with its line end.
/// @param columns  at least one.
template <class Row>
[[nodiscard]] std::string csv_line(const std::vector<Column<Row>>& columns, const Row& row) {
    std::string line;
    for (const Column<Row>& column : columns) (line += csv_text(column.value(row))) += ',';
    line.back() = '\n';
    return line;
}

/// Returns a CSV file: the header, then a line per row.  Without rows it is the header alone.
/// @param columns  at least one.
template <class Row>
[[nodiscard]] std::string csv_table(const std::vector<Column<Row>>& columns,
                                    const std::vector<Row>& rows) {
    std::string csv = csv_header(columns);
    for (const Row& row : rows) csv += csv_line(columns, row);
    return csv;
}

/// Returns the columns with these keys, in the order of the keys.  Keys that the table lacks are
/// skipped, so that one list of keys serves tables with optional columns.  A key that is given
/// twice gives its column twice.
template <class Row>
[[nodiscard]] std::vector<Column<Row>> with_keys(const std::vector<Column<Row>>& columns,
                                                 const std::vector<std::string_view>& keys) {
    std::vector<Column<Row>> chosen;
    for (const std::string_view key : keys) {
        const auto found = std::ranges::find(columns, key, &Column<Row>::key);
        if (found != columns.end()) chosen.push_back(*found);
    }
    return chosen;
}

/// Returns the columns with so many decimals where a value is in mGal.
template <class Row>
[[nodiscard]] std::vector<Column<Row>> with_decimals(std::vector<Column<Row>> columns,
                                                     int decimals) {
    for (Column<Row>& column : columns)
        if (column.key.ends_with("_mgal")) column.shown.decimals = decimals;
    return columns;
}

/// Returns a row of a table for people: a text for each column, also for those without a heading.
template <class Row>
[[nodiscard]] std::vector<std::string> shown_row(const std::vector<Column<Row>>& columns,
                                                 const Row& row) {
    std::vector<std::string> texts;
    for (const Column<Row>& column : columns)
        texts.push_back(shown_text(column.value(row), column.shown.decimals));
    return texts;
}

/// Returns a table for people, without rows.  It has all columns, also those without a heading or a
/// value.  Use it with shown_row() where some rows are made by hand.
template <class Row>
[[nodiscard]] Table empty_table(const std::vector<Column<Row>>& columns) {
    Table table;
    for (const Column<Row>& column : columns) {
        table.alignment += column.shown.alignment;
        table.headings.emplace_back(column.shown.heading);
    }
    return table;
}

/// Returns a table for people, of the columns with a heading and at least one value.  Without rows
/// it therefore has no columns.
template <class Row>
[[nodiscard]] Table table_of(std::vector<Column<Row>> columns, const std::vector<Row>& rows) {
    std::erase_if(columns, [&rows](const Column<Row>& column) {
        return column.shown.heading.empty() || std::ranges::all_of(rows, [&](const Row& row) {
                   return std::holds_alternative<std::monostate>(column.value(row));
               });
    });
    Table table = empty_table(columns);
    for (const Row& row : rows) table.rows.push_back(shown_row(columns, row));
    return table;
}

/// Returns an object with a member for each column, also for cells without a value.  The members
/// keep the order of the columns.
/// @tparam Json  not to be given.  It is a parameter so that only callers need nlohmann/json.hpp.
template <class Row, class Json = nlohmann::ordered_json>
[[nodiscard]] Json json_object(const std::vector<Column<Row>>& columns, const Row& row) {
    Json object;
    for (const Column<Row>& column : columns)
        object[std::string(column.key)] = json_value(column.value(row));
    return object;
}

/// Returns an array with json_object() of each row; an empty array without rows.
template <class Row, class Json = nlohmann::ordered_json>
[[nodiscard]] Json json_array(const std::vector<Column<Row>>& columns,
                              const std::vector<Row>& rows) {
    Json array = Json::array();
    for (const Row& row : rows) array.push_back(json_object(columns, row));
    return array;
}

}  // namespace a351::corrector::result
