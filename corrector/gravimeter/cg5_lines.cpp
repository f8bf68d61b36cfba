#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "corrector/gravimeter/fields.hpp"
#include "corrector/gravimeter/line_readers.hpp"
#include "corrector/gravimeter/site_names.hpp"
#include "protocol/text/csv_reader.hpp"
#include "protocol/text/echo.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::gravimeter {
namespace {

constexpr std::string_view kCg5Title = "CG-5 SURVEY";

/// Largest distance of a station from the coordinates in the header, by which a line without names
/// is known to begin with coordinates.  Reason: more than a day's drive; a line and a station with
/// such fractions by chance are hardly possible.
constexpr double kNear_deg = 3.0;

/// Returns a coordinate such as `1.6000000 E` in degrees, north and east positive.
/// @param directions  letters of the positive and the negative direction.
std::optional<Degrees> coordinate(std::string_view text, std::string_view directions,
                                  double greatest) {
    const auto parts = split_at_blanks(text);
    if (parts.size() != 2 || parts[1].size() != 1) return std::nullopt;
    const auto value = text::parse_number(parts[0]);
    if (!value || std::abs(*value) > greatest ||
        directions.find(parts[1][0]) == std::string_view::npos)
        return std::nullopt;
    return Degrees(parts[1][0] == directions[1] ? -*value : *value);
}

/// Returns the name of a station: `16.0000000` is 16.
std::string station_name(std::string_view text) {
    const std::size_t point = text.find('.');
    const bool is_number = text::parse_number(text) && point != std::string_view::npos;
    if (!is_number) return std::string(text);
    const std::size_t end = text.find_last_not_of('0');
    return std::string(text.substr(0, text[end] == '.' ? end : end + 1));
}

/// The reader of a file with one or more surveys.
class Cg5Lines : public LineReader {
public:
    Line read(std::string_view line) override {
        line = trimmed(line);
        if (line.empty()) return Comment{};
        if (line.starts_with("/-")) return names_line(line.substr(1));
        if (line.front() == '/') return header_line(trimmed(line.substr(1)));
        // Readings that a person has switched off, for example for GravTools.
        if (line.front() == '#') return Comment{};
        // The marker of a line of stations: `Line    2.000N`.
        if (line.starts_with("Line") && split_at_blanks(line).size() == 2) return Comment{};
        return reading_line(line);
    }

    [[nodiscard]] std::string layout() const override {
        return layout_.description +
               (is_by_note_ ? ", station from the first word of the line Note:" : "");
    }

    [[nodiscard]] std::string remark() const override {
        return stations_.empty()
                   ? ""
                   : fmt::format("stations from notes: {}", fmt::join(stations_, ", "));
    }

private:
    /// Takes the names: `/------LINE-----STATION-----ALT.---`.
    Line names_line(std::string_view line) {
        std::vector<std::string_view> names;
        for (const std::string_view name : split_at(line, '-'))
            if (!name.empty()) names.push_back(name);
        const auto has = [&](std::string_view name) {
            return std::ranges::find(names, name) != names.end();
        };
        is_by_note_ = !has("STATION") && has("LAT") && has("LONG");
        layout_ =
            is_by_note_ ? named_layout(Form::cg5, names, {"site"}) : named_layout(Form::cg5, names);
        if (!layout_.trouble.empty()) return Refusal{layout_.trouble};
        return Comment{};
    }

    /// Chooses the usual columns for a file without names.
    void take_usual_layout(const std::vector<std::string_view>& cells) {
        const auto is_coordinate = [](std::string_view cell, const std::optional<Degrees>& header) {
            const auto value = text::parse_number(cell);
            return value && header && std::abs(*value - header->value()) < kNear_deg &&
                   *value != std::round(*value);
        };
        is_by_note_ = cells.size() > 2 && is_coordinate(cells[0], survey_.latitude) &&
                      is_coordinate(cells[1], survey_.longitude);
        auto names = usual_names(Form::cg5);
        if (!is_by_note_) {
            layout_ = usual_layout(Form::cg5, names);
            return;
        }
        std::tie(names[0], names[1]) = std::pair("LAT", "LONG");
        layout_ = usual_layout(Form::cg5, names, {"site"});
        layout_.description += ", LAT and LONG known from the header";
    }

    Line header_line(std::string_view line) {
        if (line == kCg5Title) {
            // The options can be before this line.
            const auto has_tide = are_options_used_ ? std::nullopt : survey_.has_tide;
            survey_ = {};
            survey_.has_tide = has_tide;
            layout_ = {};
            note_.clear();
        }
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos) return Comment{};
        const std::string_view key = line.substr(0, colon), value = trimmed(line.substr(colon + 1));
        bool is_valid = true;
        if (key == "Instrument S/N") {
            is_valid = text::trouble_with_site_name(value).empty();
            survey_.instrument = is_valid ? fmt::format("CG-5 {}", value) : "";
        }
        if (key == "Tide Correction") {
            is_valid = value == "YES" || value == "NO";
            survey_.has_tide = is_valid ? std::optional(value == "YES") : std::nullopt;
            are_options_used_ = false;
        }
        if (key == "Note") note_ = value.substr(0, value.find_first_of(" \t"));
        if (key == "LONG")
            is_valid = (survey_.longitude = coordinate(value, "EW", 180.0)).has_value();
        if (key == "LAT") is_valid = (survey_.latitude = coordinate(value, "NS", 90.0)).has_value();
        if (key == "GMT DIFF.") {
            const auto hours = text::parse_number(value);
            is_valid = hours && std::abs(*hours) < 24.0;
            survey_.utc_minus_local.reset();
            if (is_valid)
                survey_.utc_minus_local = std::chrono::minutes(std::lround(60.0 * *hours));
        }
        if (!is_valid) return Refusal{fmt::format("{}: not as a CG-5 writes it", key)};
        return Comment{};
    }

    Line reading_line(std::string_view line) {
        const auto cells = split_at_blanks(line);
        if (layout_.places.empty()) take_usual_layout(cells);
        if (!layout_.trouble.empty()) return Refusal{"its columns are not known"};
        Fields fields(layout_, cells);
        const UtcTime time = fields.time(survey_.utc_minus_local.value_or(std::chrono::minutes(0)));
        if (!fields.trouble().empty()) return Refusal{fields.trouble()};
        Reading reading = fields.reading();
        for (const auto& [is_known, key] :
             {std::pair(!survey_.instrument.empty(), "Instrument S/N"),
              {survey_.utc_minus_local.has_value(), "GMT DIFF."},
              {survey_.has_tide.has_value(), "Tide Correction"},
              {!is_by_note_ || !note_.empty(), "Note, whose first word is the station,"}})
            if (!is_known) return Refusal{fmt::format("no header with {} before it", key)};
        reading.instrument = survey_.instrument;
        reading.time = time;
        reading.site = is_by_note_ ? note_ : station_name(reading.site);
        if (const auto trouble = text::trouble_with_site_name(table_name(reading.site));
            !trouble.empty())
            return Refusal{fmt::format("Note = {}: {}", text::echoed(note_), trouble)};
        if (!*survey_.has_tide) reading.tide_correction.reset();
        are_options_used_ = true;
        if (is_by_note_ && std::ranges::find(stations_, note_) == stations_.end())
            stations_.push_back(note_);
        if (const auto altitude = fields.number("altitude_m");
            !is_by_note_ && altitude && survey_.latitude && survey_.longitude)
            reading.position =
                tide::Station{*survey_.latitude, *survey_.longitude, Metres(*altitude)};
        return reading;
    }

    /// The header of the readings that follow.
    struct Survey {
        std::string instrument;
        std::optional<Degrees> latitude, longitude;
        /// The CG-5's `GMT DIFF.`: hours to be added to its clock to have UTC (-1 in Prague).
        std::optional<std::chrono::minutes> utc_minus_local;
        std::optional<bool> has_tide;
    };
    Survey survey_;
    Layout layout_;
    std::string note_;                   ///< First word of the last line Note:.
    std::vector<std::string> stations_;  ///< From notes, because any first word of them is one.
    bool is_by_note_ = false;            ///< It is the station.
    bool are_options_used_ = false;      ///< A reading was made with the options.
};

}  // namespace

Format cg5_format() {
    return {"Scintrex CG-5", "of the instrument",
            [](std::string_view line) {
                return line.starts_with('/') && trimmed(line.substr(1)) == kCg5Title;
            },
            [](const ReadOptions&) -> std::unique_ptr<LineReader> {
                return std::make_unique<Cg5Lines>();
            }};
}

}  // namespace a351::corrector::gravimeter
