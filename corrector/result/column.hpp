#pragma once
/// @file
/// Columns of a table, declared once and written as CSV and as JSON.

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"

namespace a351::corrector {

/// Value of a cell; std::monostate if the row has none.
using Cell = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

/// Returns the value as a cell; without a value an empty cell.
[[nodiscard]] inline Cell cell(double value) { return value; }
[[nodiscard]] inline Cell cell(const std::optional<double>& value) {
    return value ? Cell(*value) : Cell();
}
[[nodiscard]] inline Cell cell(MilliGal value) { return value.value(); }
[[nodiscard]] inline Cell cell(const std::optional<MilliGal>& value) {
    return value ? Cell(value->value()) : Cell();
}
[[nodiscard]] inline Cell cell_of_count(std::size_t count) {
    return static_cast<std::int64_t>(count);
}

/// Returns the instant in RFC 3339, to the millisecond.
[[nodiscard]] inline Cell cell(UtcTime time) { return to_rfc3339(time, 3); }
[[nodiscard]] inline Cell cell(const std::optional<UtcTime>& time) {
    return time ? Cell(to_rfc3339(*time, 3)) : Cell();
}

/// One column of a table.
template <class Row>
struct Column {
    std::string_view key;  ///< Name in every format, with the unit.
    std::function<Cell(const Row&)> value;
};

/// Returns a cell as CSV: numbers with six decimals, true and false as 1 and 0, empty without a
/// value.
[[nodiscard]] std::string csv_text(const Cell& cell);

/// Returns a cell as JSON: numbers in full, null without a value.
[[nodiscard]] nlohmann::ordered_json json_value(const Cell& cell);

/// Returns the header line of a CSV file.
template <class Row>
[[nodiscard]] std::string csv_header(const std::vector<Column<Row>>& columns) {
    std::string line;
    for (const Column<Row>& column : columns) (line += line.empty() ? "" : ",") += column.key;
    return line + '\n';
}

/// Returns a line of a CSV file.
template <class Row>
[[nodiscard]] std::string csv_line(const std::vector<Column<Row>>& columns, const Row& row) {
    std::string line;
    for (const Column<Row>& column : columns) (line += csv_text(column.value(row))) += ',';
    line.back() = '\n';
    return line;
}

/// Returns a CSV file.
template <class Row>
[[nodiscard]] std::string csv_table(const std::vector<Column<Row>>& columns,
                                    const std::vector<Row>& rows) {
    std::string csv = csv_header(columns);
    for (const Row& row : rows) csv += csv_line(columns, row);
    return csv;
}

/// Returns an object with a member for each column.
template <class Row>
[[nodiscard]] nlohmann::ordered_json json_object(const std::vector<Column<Row>>& columns,
                                                 const Row& row) {
    nlohmann::ordered_json object;
    for (const Column<Row>& column : columns)
        object[std::string(column.key)] = json_value(column.value(row));
    return object;
}

/// Returns an array with json_object() of each row.
template <class Row>
[[nodiscard]] nlohmann::ordered_json json_array(const std::vector<Column<Row>>& columns,
                                                const std::vector<Row>& rows) {
    nlohmann::ordered_json array = nlohmann::ordered_json::array();
    for (const Row& row : rows) array.push_back(json_object(columns, row));
    return array;
}

}  // namespace a351::corrector
