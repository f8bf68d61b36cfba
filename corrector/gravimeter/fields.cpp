#include "corrector/gravimeter/fields.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <tuple>

#include "corrector/gravimeter/site_names.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/csv_reader.hpp"
#include "protocol/text/echo.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::gravimeter {
namespace {

constexpr std::string_view kBlanks = " \t\v\f\r";

}  // namespace

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kBlanks);
    // Also an empty text points into the line, because join_note() of a Burris asks where it is.
    if (first == std::string_view::npos) return text.substr(text.size());
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

std::optional<Day> parse_day(std::string_view text) {
    const auto parts = split_at(text, text.find('/') != std::string_view::npos ? '/' : '-');
    constexpr std::string_view kDigits = "0123456789";
    if (parts.size() != 3) return std::nullopt;
    for (const std::string_view part : parts)
        if (part.empty() || part.find_first_not_of(kDigits) != std::string_view::npos)
            return std::nullopt;
    const auto two = [](std::string_view part) {
        return part.size() == 1 ? "0" + std::string(part) : std::string(part);
    };
    const bool has_year_last = parts[2].size() == 4;
    const auto& [year, month, day] = has_year_last ? std::tuple(parts[2], parts[0], parts[1])
                                                   : std::tuple(parts[0], parts[1], parts[2]);
    return Day{std::string(year) + "-" + two(month) + "-" + two(day), has_year_last};
}

Fields::Fields(const Layout& layout, const std::vector<std::string_view>& cells) {
    const auto& places = layout.places;
    if (cells.size() != places.size()) {
        trouble_ = fmt::format("{} columns; allowed: {}", cells.size(), places.size());
        return;
    }
    for (std::size_t i = 0; i < cells.size() && trouble_.empty(); ++i) {
        const bool is_given = cells[i].find_first_not_of('-') != std::string_view::npos &&
                              cells[i].find_first_not_of('*') != std::string_view::npos;
        cells_.push_back({&places[i], is_given ? cells[i] : std::string_view(), std::nullopt});
        if (is_given || places[i].column->is_required) {
            cells_.back().text = cells[i];
            check(cells_.back());
        }
    }
}

void Fields::check(Cell& cell) {
    const auto& [name, column, factor] = *cell.place;
    switch (column->type) {
        case CellType::text:
            break;
        case CellType::site:
        case CellType::instrument: {
            const bool is_site = column->type == CellType::site;
            if (const std::string trouble = text::trouble_with_site_name(
                    is_site ? table_name(cell.text) : std::string(cell.text));
                !trouble.empty())
                refuse(name, cell.text, trouble);
            break;
        }
        case CellType::number: {
            const auto value = text::parse_number(cell.text);
            if (value) cell.number = *value * factor;
            if (!value || *cell.number < column->low || *cell.number > column->high)
                refuse(name, cell.text,
                       fmt::format("{}; allowed: {} to {}", value ? "out of range" : "not a number",
                                   text::shortest(column->low / factor),
                                   text::shortest(column->high / factor)));
            break;
        }
        case CellType::date:
        case CellType::time:
            break;  // time() needs both
        case CellType::flags:
            constexpr std::size_t kFlagCount = 5;
            if (cell.text.size() != kFlagCount ||
                cell.text.find_first_not_of("01") != std::string_view::npos)
                refuse(name, cell.text, "not five digits 0 or 1");
            break;
    }
}

void Fields::refuse(std::string_view name, std::string_view cell, std::string_view reason) {
    if (trouble_.empty()) trouble_ = fmt::format("{} = {}: {}", name, text::echoed(cell), reason);
}

const Fields::Cell* Fields::find(std::string_view field) const {
    const auto found = std::ranges::find_if(
        cells_, [&](const Cell& cell) { return cell.place->column->field == field; });
    return found == cells_.end() ? nullptr : &*found;
}

std::string_view Fields::text(std::string_view field) const {
    const Cell* const cell = find(field);
    return cell != nullptr ? cell->text : std::string_view();
}

std::optional<double> Fields::number(std::string_view field) const {
    const Cell* const cell = find(field);
    return cell != nullptr ? cell->number : std::nullopt;
}

UtcTime Fields::time(std::chrono::minutes utc_minus_local, bool allows_month_first) {
    const Cell *const date = find("date"), *const clock = find("time");
    if (date == nullptr || clock == nullptr) return {};
    auto day = parse_day(date->text);
    const bool is_doubtful = day && day->has_year_last && !allows_month_first;
    if (is_doubtful) day.reset();
    const bool is_short_hour = clock->text.find(':') == 1;
    if (const auto parsed = parse_rfc3339_in_zone(
            fmt::format("{}T{}{}", day ? day->iso : "", is_short_hour ? "0" : "", clock->text),
            -utc_minus_local))
        return *parsed;
    refuse(fmt::format("{} {}", date->place->name, clock->place->name),
           fmt::format("{} {}", date->text, clock->text),
           is_doubtful ? "not an instant, month and day can be either; allowed: YYYY-MM-DD hh:mm:ss"
                       : "not an instant; allowed: YYYY/MM/DD hh:mm:ss");
    return {};
}

std::optional<tide::Station> Fields::position(std::string_view prefix) const {
    const auto of = [&](std::string_view name) {
        return number(fmt::format("{}{}", prefix, name));
    };
    const auto latitude = of("latitude_deg"), longitude = of("longitude_deg"),
               altitude = of("altitude_m");
    if (!latitude || !longitude || !altitude) return std::nullopt;
    return tide::Station{Degrees(*latitude), Degrees(*longitude), Metres(*altitude)};
}

Reading Fields::reading() const {
    Reading reading;
    reading.site = std::string(text("site"));
    reading.instrument = std::string(text("instrument"));
    if (const auto value = number("reading_mgal")) reading.value = MilliGal(*value);
    if (const auto tide = number("tide_correction_mgal")) reading.tide_correction = MilliGal(*tide);
    if (const auto dial = number("dial")) reading.dial = text::shortest(*dial);
    if (const auto height = number("instrument_height_m")) reading.height = Metres(*height);
    reading.position = position("");
    reading.receiver = position("receiver_");
    if (!reading.position) reading.position = reading.receiver;
    for (const Column& column : columns())
        if (const Cell* const cell = column.is_kept ? find(column.field) : nullptr)
            reading.kept.emplace_back(column.field, cell->text);
    return reading;
}

}  // namespace a351::corrector::gravimeter
