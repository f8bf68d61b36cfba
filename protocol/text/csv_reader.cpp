#include "protocol/text/csv_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"

namespace a351::text {
namespace {

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r";
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

void split(std::string_view line, std::vector<std::string_view>& cells) {
    cells.clear();
    while (true) {
        const std::size_t comma = line.find(',');
        cells.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) return;
        line.remove_prefix(comma + 1);
    }
}

}  // namespace

CsvReader::CsvReader(std::istream& in, std::filesystem::path origin)
    : in_(in), origin_(std::move(origin)) {
    if (!next_line()) {
        throw InputError(origin_.string() + ":1: no header line; allowed: column names");
    }
    for (auto cell = cells_.begin(); cell != cells_.end(); ++cell) {
        if (std::find(cells_.begin(), cell, *cell) != cell) {
            throw InputError(origin_.string() + ":" + std::to_string(line_) + ": column " +
                             std::string(*cell) + " appears twice; allowed: once");
        }
    }
    columns_.assign(cells_.begin(), cells_.end());
}

bool CsvReader::next() {
    if (!next_line()) return false;
    if (cells_.size() != columns_.size()) {
        throw InputError(
            origin_.string() + ":" + std::to_string(line_) + ": " + std::to_string(cells_.size()) +
            " cells; allowed: " + std::to_string(columns_.size()) + " as in the header");
    }
    return true;
}

/// Reads the next line that is a row and splits it into cells.
bool CsvReader::next_line() {
    while (std::getline(in_, text_)) {
        std::string_view content = text_;
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
        if (++line_ == 1 && content.starts_with(kByteOrderMark)) {
            content.remove_prefix(kByteOrderMark.size());
        }
        if (!is_row(content)) continue;
        split(content, cells_);
        return true;
    }
    if (in_.bad()) {
        throw InputError(origin_.string() + ": cannot be read after line " + std::to_string(line_) +
                         "; allowed: a readable file");
    }
    return false;
}

/// Returns true if a line is a row.  In a table of one column, a blank line between rows is a
/// missing cell; skipping it would shift all later rows.
bool CsvReader::is_row(std::string_view content) {
    if (!trimmed(content).empty()) return true;
    return columns_.size() == 1 && !in_.eof() && in_.peek() != std::istream::traits_type::eof();
}

void CsvReader::refuse(std::size_t column, std::string_view trouble,
                       std::string_view allowed) const {
    throw InputError(origin_.string() + ":" + std::to_string(line_) + ": " + columns_.at(column) +
                     " = " + std::string(cells_.at(column)) + ": " + std::string(trouble) +
                     "; allowed: " + std::string(allowed));
}

std::size_t column_index(const std::vector<std::string>& columns, std::string_view column,
                         const std::filesystem::path& origin) {
    const auto found = std::find(columns.begin(), columns.end(), column);
    if (found == columns.end()) {
        throw InputError(origin.string() + ":1: column " + std::string(column) +
                         " is missing; there are: " + joined(columns, ","));
    }
    return static_cast<std::size_t>(found - columns.begin());
}

std::optional<double> parse_number(std::string_view text) {
    double value = 0.0;
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

}  // namespace a351::text
