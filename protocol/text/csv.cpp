#include "protocol/text/csv.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "protocol/core/input_error.hpp"
#include "protocol/text/csv_reader.hpp"
#include "protocol/text/echo.hpp"
#include "protocol/text/text_file.hpp"

namespace a351::text {

CsvTable CsvTable::parse(std::string_view text, std::filesystem::path origin) {
    CsvTable table;
    table.origin_ = std::move(origin);
    std::istringstream in{std::string(text)};
    CsvReader reader(in, table.origin_);
    table.columns_ = reader.columns();
    while (reader.next()) {
        const auto& cells = reader.cells();
        if (cells.size() > 1 && std::ranges::all_of(cells, &std::string_view::empty)) continue;
        table.rows_.push_back({reader.line(), {cells.begin(), cells.end()}});
    }
    table.decimal_sign_ = reader.decimal_sign();
    return table;
}

bool CsvTable::has_column(std::string_view name) const {
    return std::ranges::find(columns_, name) != columns_.end();
}

const std::string& CsvTable::cell(std::size_t row, std::string_view column) const {
    return rows_.at(row).cells[column_index(columns_, column, origin_)];
}

double CsvTable::number(std::size_t row, std::string_view column, double low, double high) const {
    const std::optional<double> value = decimal_sign_.number(cell(row, column));
    if (!value) refuse(row, column, "not a number", "a finite number with a decimal point");
    if (!(*value >= low && *value <= high))
        refuse(row, column, "out of range", shortest(low) + " to " + shortest(high));
    return *value;
}

double CsvTable::unrounded(std::size_t row, std::string_view column, double digit, double low,
                           double high) const {
    const double value = number(row, column, low, high);
    const std::string& text = cell(row, column);
    const std::size_t exponent = text.find_first_of("eE");
    if (exponent == std::string::npos) return value;
    const std::size_t point = text.find_first_of(".,");
    const auto decimals = point < exponent ? static_cast<double>(exponent - point - 1) : 0.0;
    const double power = std::atoi(text.c_str() + exponent + 1);
    if (std::pow(10.0, power - decimals) > digit)
        refuse(row, column, "rounded by a spreadsheet", "all digits, without an exponent");
    return value;
}

std::optional<double> CsvTable::number_if_given(std::size_t row, std::string_view column,
                                                double low, double high) const {
    if (cell(row, column).empty()) return std::nullopt;
    return number(row, column, low, high);
}

std::vector<UtcTime> CsvTable::ascending_times(std::string_view column) const {
    std::vector<UtcTime> times;
    for (std::size_t row = 0; row < row_count(); ++row) {
        const auto time = parse_rfc3339(cell(row, column));
        if (!time) refuse(row, column, "not an instant", "YYYY-MM-DDThh:mm:ss with zone");
        if (!times.empty() && *time <= times.back())
            refuse(row, column, "not after the row before it", "ascending times");
        times.push_back(*time);
    }
    return times;
}

void CsvTable::refuse(std::size_t row, std::string_view column, std::string_view trouble,
                      std::string_view allowed) const {
    throw InputError(fmt::format("{}:{}: {} = {}: {}; allowed: {}{}", origin_.string(),
                                 rows_.at(row).line, column, echoed(cell(row, column)), trouble,
                                 allowed, DecimalSign::remedy(cell(row, column))));
}

CsvTable read_csv(const std::filesystem::path& file) {
    return CsvTable::parse(read_text_file(file), file);
}

std::string shortest(double value) {
    char digits[32];
    return std::string(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

}  // namespace a351::text
