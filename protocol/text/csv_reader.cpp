#include "protocol/text/csv_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>

#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/echo.hpp"

namespace a351::text {
namespace {

/// Returns true for the columns that are named with a unit.  In others, names and words may look like
/// numbers.
bool is_number_column(std::string_view name) {
    constexpr std::array<std::string_view, 7> kUnits{"deg", "degc", "g", "hpa", "m", "mgal", "s"};
    const std::size_t mark = name.rfind('_');
    return name == "time" || (mark != std::string_view::npos &&
                              std::ranges::find(kUnits, name.substr(mark + 1)) != kUnits.end());
}

}  // namespace

CsvReader::CsvReader(std::istream& in, std::filesystem::path origin)
    : lines_(in), origin_(std::move(origin)), line_(1) {
    if (!next_line())
        throw InputError(origin_.string() + ":1: no header line; allowed: column names");
    auto names = lines_.cells();
    while (names.size() > 1 && names.back().empty()) names.pop_back();
    for (auto name = names.begin(); name != names.end(); ++name) {
        if (std::find(names.begin(), name, *name) != name)
            refuse_line(fmt::format("column {} appears twice; allowed: once", echoed(*name)));
    }
    if (names.size() == 1 && names.front().find_first_of(",;\t") != std::string_view::npos)
        refuse_line(
            fmt::format("the whole line is one cell in quotation marks; allowed: a cell "
                        "for each column{}",
                        kHowToSave));
    columns_.assign(names.begin(), names.end());
    std::ranges::transform(columns_, std::back_inserter(is_number_), is_number_column);
}

bool CsvReader::next() {
    if (empty_rows_ > 0) {
        --empty_rows_;
    } else {
        while (true) {
            if (!next_line()) {
                empty_rows_ = 0;
                return false;
            }
            check_width();
            note_decimal_signs();
            if (columns_.size() == 1 ||
                !std::ranges::all_of(lines_.cells(), &std::string_view::empty))
                break;
            ++empty_rows_;
        }
    }
    cells_ = lines_.cells();
    cells_.resize(columns_.size());
    if (empty_rows_ > 0) cells_.assign(columns_.size(), {});
    line_ = lines_.line() - empty_rows_;
    return true;
}

bool CsvReader::next_line() {
    if (lines_.next(columns_.size() == 1)) {
        line_ = lines_.line();
        return true;
    }
    if (!lines_.trouble().empty()) {
        line_ = std::max<std::size_t>(lines_.line(), 1);
        refuse_line(lines_.trouble());
    }
    if (lines_.is_broken()) {
        throw InputError(fmt::format("{}: cannot be read after line {}; allowed: a readable file",
                                     origin_.string(), line_));
    }
    return false;
}

/// Checks the number of cells of a line.  A spreadsheet can write empty cells after the last column.
void CsvReader::check_width() const {
    const auto& cells = lines_.cells();
    const std::size_t width = columns_.size();
    if (cells.size() == width) return;
    if (cells.size() > width &&
        std::all_of(cells.begin() + static_cast<std::ptrdiff_t>(width), cells.end(),
                    [](std::string_view cell) { return cell.empty(); }))
        return;
    refuse_line(fmt::format(
        "{} cells; allowed: {} as in the header{}", cells.size(), width,
        cells.size() > width && lines_.separator() == ','
            ? "; a comma outside quotation marks always separates, and a number has a point"
            : ""));
}

/// Finds the decimal sign.  In a table with commas a cell has a comma only in quotation marks, so
/// that after a number with a point the other lines need no look.
void CsvReader::note_decimal_signs() {
    if (decimal_sign_.sign() == '.' && lines_.separator() == ',' &&
        lines_.text().find('"') == std::string_view::npos)
        return;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        const std::string_view cell = lines_.cells()[i];
        if (!is_number_[i] || decimal_sign_.note(cell)) continue;
        refuse_line(
            fmt::format("{} = {}: other numbers of this table have a decimal {}; allowed: "
                        "one sign in a table{}",
                        echoed(columns_[i]), echoed(cell),
                        decimal_sign_.sign() == ',' ? "comma" : "point", kHowToSave));
    }
}

UtcTime CsvReader::instant(std::size_t column) const {
    constexpr double kMostSeconds = 9e9;  // limit of from_seconds()
    if (const auto instant = parse_rfc3339(cells_[column])) return *instant;
    const auto seconds = number(column);
    if (!seconds || std::abs(*seconds) >= kMostSeconds)
        refuse(column, "not a time", "an RFC 3339 time, or seconds");
    return UtcTime(from_seconds(*seconds));
}

double CsvReader::sample(std::size_t column, double largest) const {
    if (cells_[column].empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto value = number(column);
    if (!value || std::abs(*value) > largest)
        refuse(column, value ? "out of range" : "not a finite number",
               "a number with a decimal point, or nothing for a missing sample");
    return *value;
}

void CsvReader::refuse(std::size_t column, std::string_view trouble,
                       std::string_view allowed) const {
    refuse_line(fmt::format("{} = {}: {}; allowed: {}{}", echoed(columns_.at(column)),
                            echoed(cells_.at(column)), trouble, allowed,
                            DecimalSign::remedy(cells_.at(column))));
}

void CsvReader::refuse_line(std::string_view trouble) const {
    throw InputError(fmt::format("{}:{}: {}", origin_.string(), line_, trouble));
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
