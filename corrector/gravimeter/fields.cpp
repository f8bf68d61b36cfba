#include "corrector/gravimeter/fields.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "protocol/text/csv.hpp"
#include "protocol/text/csv_reader.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::gravimeter {
namespace {

constexpr std::string_view kBlanks = " \t\v\f\r";

/// Returns the beginning of a cell in printable ASCII, for a message.
std::string shown(std::string_view cell) {
    constexpr std::size_t kMostShown = 24;
    std::string text(cell.substr(0, kMostShown));
    for (char& letter : text)
        if (letter < ' ' || letter > '~') letter = '?';
    if (cell.size() > kMostShown) text += "...";
    return text;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string_view> split_at_blanks(std::string_view line) {
    std::vector<std::string_view> parts;
    for (line = trimmed(line); !line.empty();) {
        const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
        parts.push_back(line.substr(0, end));
        line = trimmed(line.substr(end));
    }
    return parts;
}

std::vector<std::string_view> split_at(std::string_view line, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t end = 0; end != std::string_view::npos;) {
        end = line.find(separator);
        parts.push_back(trimmed(line.substr(0, end)));
        if (end != std::string_view::npos) line.remove_prefix(end + 1);
    }
    return parts;
}

Fields::Fields(std::vector<std::string_view> cells, const std::vector<std::string_view>& names)
    : cells_(std::move(cells)), names_(names) {
    if (cells_.size() != names_.size())
        trouble_ = fmt::format("{} columns; allowed: {}", cells_.size(), names_.size());
}

void Fields::refuse(std::string_view name, std::string_view cell, std::string_view reason) {
    if (trouble_.empty()) trouble_ = fmt::format("{} = {}: {}", name, shown(cell), reason);
}

std::string_view Fields::text(std::string_view name) {
    const auto at = static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin());
    if (at < cells_.size()) return cells_[at];
    if (trouble_.empty()) trouble_ = fmt::format("no column {}", name);
    return {};
}

double Fields::number(std::string_view name, double low, double high) {
    const std::string_view cell = text(name);
    const auto value = text::parse_number(cell);
    if (value && *value >= low && *value <= high) return *value;
    refuse(name, cell,
           fmt::format("{}; allowed: {} to {}", value ? "out of range" : "not a number",
                       text::shortest(low), text::shortest(high)));
    return 0.0;
}

std::string Fields::site(std::string_view name) {
    const std::string_view cell = text(name);
    if (const std::string trouble = text::trouble_with_site_name(cell); !trouble.empty())
        refuse(name, cell, trouble);
    return std::string(cell);
}

UtcTime Fields::time(std::string_view date, std::string_view time,
                     std::chrono::minutes utc_minus_local) {
    const std::string_view day = text(date), clock = text(time);
    std::string instant(day);
    std::ranges::replace(instant, '/', '-');
    instant.append("T").append(clock);
    if (const auto parsed = parse_rfc3339_in_zone(instant, -utc_minus_local)) return *parsed;
    refuse(fmt::format("{} {}", date, time), fmt::format("{} {}", day, clock),
           "not an instant; allowed: YYYY/MM/DD hh:mm:ss");
    return {};
}

bool Fields::is_given(std::string_view name) {
    return text(name).find_first_not_of('-') != std::string_view::npos;
}

}  // namespace a351::corrector::gravimeter
