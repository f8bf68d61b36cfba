#include "protocol/text/csv_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/echo.hpp"

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

/// Returns true if a line begins a miniSEED record: six digits and a mark of quality (SEED 2.4,
/// chapter 8), or MS and the version (FDSN miniSEED 3).
bool is_miniseed(std::string_view line) {
    constexpr std::size_t kSequence = 6;
    return line.starts_with("MS\x03") ||
           (line.size() > kSequence + 1 && line.find_first_not_of("0123456789") == kSequence &&
            std::string_view("DRQM").find(line[kSequence]) != std::string_view::npos &&
            line[kSequence + 1] == ' ');
}

/// Returns why a header is not that of a table with commas, and what is allowed; empty if it may be.
std::string trouble_with_header(std::string_view header) {
    constexpr const char* kHow = "; in a spreadsheet: save as CSV UTF-8, with commas";
    const auto has = [&](char c) { return header.find(c) != std::string_view::npos; };
    if (has('\0')) return fmt::format("UTF-16, or no text; allowed: UTF-8{}", kHow);
    if (!has(',') && has(';'))
        return fmt::format("the columns are separated by semicolons; allowed: commas{}", kHow);
    if (!has(',') && has('\t'))
        return fmt::format("the columns are separated by tabs; allowed: commas{}", kHow);
    if (has('"')) return "cells are in quotation marks; allowed: without them";
    return {};
}

}  // namespace

CsvReader::CsvReader(std::istream& in, std::filesystem::path origin)
    : in_(in), origin_(std::move(origin)) {
    if (!next_line())
        throw InputError(origin_.string() + ":1: no header line; allowed: column names");
    if (is_miniseed(text_))
        throw InputError(
            origin_.string() +
            ": a miniSEED file; allowed: a table (CSV), or miniSEED in the archive of a "
            "data root with metadata/station.xml");
    if (const std::string trouble = trouble_with_header(text_); !trouble.empty())
        throw InputError(fmt::format("{}:{}: {}", origin_.string(), line_, trouble));
    for (auto cell = cells_.begin(); cell != cells_.end(); ++cell) {
        if (std::find(cells_.begin(), cell, *cell) != cell) {
            throw InputError(fmt::format("{}:{}: column {} appears twice; allowed: once",
                                         origin_.string(), line_, echoed(*cell)));
        }
    }
    columns_.assign(cells_.begin(), cells_.end());
}

bool CsvReader::next() {
    if (!next_line()) return false;
    if (cells_.size() != columns_.size()) {
        const char* const hint = cells_.size() > columns_.size()
                                     ? "; a comma always separates, and a number has a point"
                                     : "";
        throw InputError(fmt::format("{}:{}: {} cells; allowed: {} as in the header{}",
                                     origin_.string(), line_, cells_.size(), columns_.size(),
                                     hint));
    }
    return true;
}

/// Reads the next line that is a row and splits it into cells.  In a table of one column, a blank
/// line between rows is a missing cell; skipping it would shift all later rows.
bool CsvReader::next_line() {
    while (std::getline(in_, text_)) {
        std::string_view content = text_;
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
        if (++line_ == 1 && content.starts_with(kByteOrderMark))
            content.remove_prefix(kByteOrderMark.size());
        if (trimmed(content).empty() &&
            (columns_.size() != 1 || in_.eof() || in_.peek() == std::istream::traits_type::eof()))
            continue;
        split(content, cells_);
        return true;
    }
    if (in_.bad()) {
        throw InputError(fmt::format("{}: cannot be read after line {}; allowed: a readable file",
                                     origin_.string(), line_));
    }
    return false;
}

UtcTime CsvReader::instant(std::size_t column) const {
    constexpr double kMostSeconds = 9e9;  // limit of from_seconds()
    if (const auto instant = parse_rfc3339(cells_[column])) return *instant;
    const auto seconds = parse_number(cells_[column]);
    if (!seconds || std::abs(*seconds) >= kMostSeconds)
        refuse(column, "not a time", "an RFC 3339 time, or seconds");
    return UtcTime(from_seconds(*seconds));
}

double CsvReader::sample(std::size_t column, double largest) const {
    if (cells_[column].empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto number = parse_number(cells_[column]);
    if (!number || std::abs(*number) > largest)
        refuse(column, number ? "out of range" : "not a finite number",
               "a number with a decimal point, or nothing for a missing sample");
    return *number;
}

void CsvReader::refuse(std::size_t column, std::string_view trouble,
                       std::string_view allowed) const {
    throw InputError(fmt::format("{}:{}: {} = {}: {}; allowed: {}", origin_.string(), line_,
                                 echoed(columns_.at(column)), echoed(cells_.at(column)), trouble,
                                 allowed));
}

std::size_t column_index(const std::vector<std::string>& columns, std::string_view column,
                         const std::filesystem::path& origin) {
    const auto found = std::ranges::find(columns, column);
    if (found == columns.end()) {
        throw InputError(fmt::format("{}:1: column {} is missing; there are: {}", origin.string(),
                                     column, echoed(joined(columns, ","))));
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
