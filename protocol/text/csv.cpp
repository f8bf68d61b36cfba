#include "protocol/text/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "protocol/core/input_error.hpp"
#include "protocol/text/text_file.hpp"

namespace a351::text {
namespace {

std::string trimmed(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r";
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return {};
    return std::string(text.substr(first, text.find_last_not_of(kBlanks) - first + 1));
}

std::vector<std::string> split(std::string_view line) {
    std::vector<std::string> cells;
    while (true) {
        const std::size_t comma = line.find(',');
        cells.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

std::string joined(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ",") + name;
    return list;
}

}  // namespace

CsvTable CsvTable::parse(std::string_view text, std::filesystem::path origin) {
    CsvTable table;
    table.origin_ = std::move(origin);
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());

    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = text.find('\n');
        const std::string_view content = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (trimmed(content).empty()) continue;
        std::vector<std::string> cells = split(content);
        const std::string where = table.origin_.string() + ":" + std::to_string(line) + ": ";
        if (table.columns_.empty()) {
            for (auto cell = cells.begin(); cell != cells.end(); ++cell) {
                if (std::find(cells.begin(), cell, *cell) != cell) {
                    throw InputError(where + "column " + *cell + " stands twice; allowed: once");
                }
            }
            table.columns_ = std::move(cells);
        } else if (cells.size() != table.columns_.size()) {
            throw InputError(where + std::to_string(cells.size()) + " cells; allowed: " +
                             std::to_string(table.columns_.size()) + " as in the header");
        } else {
            table.rows_.push_back({line, std::move(cells)});
        }
    }
    if (table.columns_.empty()) {
        throw InputError(table.origin_.string() + ":1: no header line; allowed: column names");
    }
    return table;
}

bool CsvTable::has_column(std::string_view name) const {
    return std::find(columns_.begin(), columns_.end(), name) != columns_.end();
}

std::size_t CsvTable::index_of(std::string_view column) const {
    const auto found = std::find(columns_.begin(), columns_.end(), column);
    if (found == columns_.end()) {
        throw InputError(origin_.string() + ":1: column " + std::string(column) +
                         " is missing; there are: " + joined(columns_));
    }
    return static_cast<std::size_t>(found - columns_.begin());
}

const std::string& CsvTable::cell(std::size_t row, std::string_view column) const {
    return rows_.at(row).cells[index_of(column)];
}

double CsvTable::number(std::size_t row, std::string_view column, double low, double high) const {
    const std::string& text = cell(row, column);
    double value = 0.0;
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end || !std::isfinite(value)) {
        refuse(row, column, "not a number", "a finite number with a decimal point");
    }
    if (!(value >= low && value <= high)) {
        refuse(row, column, "out of range", shortest(low) + " to " + shortest(high));
    }
    return value;
}

std::optional<double> CsvTable::number_if_given(std::size_t row, std::string_view column,
                                                double low, double high) const {
    if (cell(row, column).empty()) return std::nullopt;
    return number(row, column, low, high);
}

void CsvTable::refuse(std::size_t row, std::string_view column, std::string_view trouble,
                      std::string_view allowed) const {
    throw InputError(origin_.string() + ":" + std::to_string(rows_.at(row).line) + ": " +
                     std::string(column) + " = " + cell(row, column) + ": " + std::string(trouble) +
                     "; allowed: " + std::string(allowed));
}

CsvTable read_csv(const std::filesystem::path& file) {
    return CsvTable::parse(read_text_file(file), file);
}

std::string shortest(double value) {
    char digits[32];
    return std::string(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

}  // namespace a351::text
