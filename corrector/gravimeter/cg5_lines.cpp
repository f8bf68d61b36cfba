#include <fmt/core.h>

#include <cmath>

#include "corrector/gravimeter/fields.hpp"
#include "corrector/gravimeter/line_readers.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/csv_reader.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::gravimeter {
namespace {

constexpr std::string_view kCg5Title = "CG-5 SURVEY";

const std::vector<std::string_view> kCg5Columns{
    "LINE", "STATION", "ALT.", "GRAV.", "SD.",           "TILTX",   "TILTY", "TEMP",
    "TIDE", "DUR",     "REJ",  "TIME",  "DEC.TIME+DATE", "TERRAIN", "DATE"};

/// Returns a coordinate such as `1.6000000 E` in degrees, north and east positive.
std::optional<Degrees> coordinate(std::string_view text) {
    const auto parts = split_at_blanks(text);
    if (parts.size() != 2 || parts[1].size() != 1) return std::nullopt;
    const auto value = text::parse_number(parts[0]);
    if (!value || std::string_view("NESW").find(parts[1][0]) == std::string_view::npos)
        return std::nullopt;
    return Degrees(parts[1] == "S" || parts[1] == "W" ? -*value : *value);
}

/// Returns the name of a station: `16.0000000` is 16.
std::string station_name(std::string_view text) {
    const auto number = text::parse_number(text);
    return number ? text::shortest(*number) : std::string(text);
}

/// The reader of a file with one or more surveys.
class Cg5Lines {
public:
    Line operator()(std::string_view line) {
        line = trimmed(line);
        if (line.empty()) return Comment{};
        if (line.front() == '/') return header_line(trimmed(line.substr(1)));
        // The marker of a line of stations: `Line    2.000N`.
        if (line.starts_with("Line") && split_at_blanks(line).size() == 2) return Comment{};
        return reading_line(line);
    }

private:
    Line header_line(std::string_view line) {
        if (line == kCg5Title) survey_ = {};
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
        }
        if (key == "LONG") is_valid = (survey_.longitude = coordinate(value)).has_value();
        if (key == "LAT") is_valid = (survey_.latitude = coordinate(value)).has_value();
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

    [[nodiscard]] Line reading_line(std::string_view line) const {
        Fields fields(split_at_blanks(line), kCg5Columns);
        Reading reading;
        reading.instrument = survey_.instrument;
        reading.site = station_name(fields.site("STATION"));
        reading.time =
            fields.time("DATE", "TIME", survey_.utc_minus_local.value_or(std::chrono::minutes(0)));
        reading.value =
            MilliGal(fields.number("GRAV.", -kGreatestReading_mgal, kGreatestReading_mgal));
        const MilliGal tide(fields.number("TIDE", -kGreatestTide_mgal, kGreatestTide_mgal));
        if (survey_.has_tide.value_or(false)) reading.tide_correction = tide;
        const Metres altitude(fields.number("ALT.", -500.0, 9000.0));
        if (survey_.latitude && survey_.longitude)
            reading.position = Position{*survey_.latitude, *survey_.longitude, altitude};
        for (const auto& [name, column] : {std::pair("sd_mgal", "SD."),
                                           {"tilt_x_arcsec", "TILTX"},
                                           {"tilt_y_arcsec", "TILTY"},
                                           {"temperature_offset_mk", "TEMP"},
                                           {"duration_s", "DUR"},
                                           {"rejected", "REJ"},
                                           {"line_name", "LINE"},
                                           {"terrain_correction_mgal", "TERRAIN"}})
            reading.kept.emplace_back(name, fields.text(column));
        if (!fields.trouble().empty()) return Refusal{fields.trouble()};
        for (const auto& [is_known, key] :
             {std::pair(!survey_.instrument.empty(), "Instrument S/N"),
              {survey_.utc_minus_local.has_value(), "GMT DIFF."},
              {survey_.has_tide.has_value(), "Tide Correction"}})
            if (!is_known) return Refusal{fmt::format("no header with {} before it", key)};
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
};

}  // namespace

Format cg5_format() {
    return {"Scintrex CG-5",
            [](std::string_view line) {
                return line.starts_with('/') && trimmed(line.substr(1)) == kCg5Title;
            },
            [] { return LineReader(Cg5Lines()); }};
}

}  // namespace a351::corrector::gravimeter
