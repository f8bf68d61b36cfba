#include <algorithm>

#include "corrector/gravimeter/fields.hpp"
#include "corrector/gravimeter/line_readers.hpp"

namespace a351::corrector::gravimeter {
namespace {

/// The columns.  The reading is a constant + feedback + tide + tilt + temperature.
const std::vector<std::string_view> kBurrisColumns{
    "station", "operator",  "meter",    "date",     "time",        "reading",
    "dial",    "feedback",  "tide",     "tilt",     "temperature", "beam error",
    "height",  "elevation", "latitude", "longitude"};

Line burris_line(std::string_view line) {
    if (trimmed(line).empty()) return Comment{};
    Fields fields(
        line.find(',') != std::string_view::npos ? split_at(line, ',') : split_at_blanks(line),
        kBurrisColumns);
    Reading reading;
    reading.site = fields.site("station");
    reading.instrument = fields.site("meter");
    reading.time = fields.time("date", "time");
    reading.value =
        MilliGal(fields.number("reading", -kGreatestReading_mgal, kGreatestReading_mgal));
    reading.dial = fields.text("dial");
    reading.tide_correction =
        MilliGal(fields.number("tide", -kGreatestTide_mgal, kGreatestTide_mgal));
    reading.height = Metres(fields.number("height", -10.0, 10.0));
    reading.position = Position{Degrees(fields.number("latitude", -90.0, 90.0)),
                                Degrees(fields.number("longitude", -180.0, 360.0)),
                                Metres(fields.number("elevation", -500.0, 9000.0))};
    for (const auto& [name, column] : {std::pair("feedback_mgal", "feedback"),
                                       {"tilt_correction_mgal", "tilt"},
                                       {"temperature_correction_mgal", "temperature"},
                                       {"beam_error", "beam error"}})
        reading.kept.emplace_back(name, fields.text(column));
    if (!fields.trouble().empty()) return Refusal{fields.trouble()};
    return reading;
}

}  // namespace

Format burris_format() {
    return {
        "ZLS Burris",
        [](std::string_view line) { return std::holds_alternative<Reading>(burris_line(line)); },
        [] { return LineReader(burris_line); }};
}

}  // namespace a351::corrector::gravimeter
