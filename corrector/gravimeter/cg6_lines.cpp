#include <fmt/core.h>

#include <memory>

#include "corrector/gravimeter/fields.hpp"
#include "corrector/gravimeter/line_readers.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::gravimeter {
namespace {

constexpr std::string_view kCg6Title = "CG-6 Survey";

/// Corrections that the value contains, one digit each: drift, temperature, unused, tide, tilt.
constexpr std::string_view kFlags = "Corrections[drift-temp-na-tide-tilt]";
constexpr std::size_t kFlagCount = 5, kTideFlag = 3;

/// The reader of a file with one or more surveys.
class Cg6Lines {
public:
    Line operator()(std::string_view line) {
        if (trimmed(line).empty()) return Comment{};
        if (line.front() == '/') return header_line(trimmed(line.substr(1)));
        return reading_line(line);
    }

private:
    Line header_line(std::string_view line) {
        if (line == kCg6Title) {
            instrument_.clear();
            columns_.clear();
        }
        constexpr std::string_view kSerial = "Instrument Serial Number:";
        if (line.starts_with(kSerial)) {
            const std::string_view serial = trimmed(line.substr(kSerial.size()));
            if (!text::trouble_with_site_name(serial).empty())
                return Refusal{"Instrument Serial Number: not as a CG-6 writes it"};
            instrument_ = fmt::format("CG-6 {}", serial);
        }
        if (line.starts_with("Station\t")) {
            names_ = line;
            columns_ = split_at(names_, '\t');
        }
        return Comment{};
    }

    [[nodiscard]] Line reading_line(std::string_view line) const {
        if (instrument_.empty() || columns_.empty())
            return Refusal{"no header with serial number and names of columns before it"};
        Fields fields(split_at(line, '\t'), columns_);
        Reading reading;
        reading.instrument = instrument_;
        reading.site = fields.site("Station");
        reading.time = fields.time("Date", "Time");
        reading.value =
            MilliGal(fields.number("CorrGrav", -kGreatestReading_mgal, kGreatestReading_mgal));
        const std::string_view flags = fields.text(kFlags);
        if (flags.size() != kFlagCount || flags.find_first_not_of("01") != std::string_view::npos) {
            if (!fields.trouble().empty()) return Refusal{fields.trouble()};
            return Refusal{fmt::format("{}: not five digits 0 or 1", kFlags)};
        }
        if (flags[kTideFlag] == '1')
            reading.tide_correction =
                MilliGal(fields.number("TideCorr", -kGreatestTide_mgal, kGreatestTide_mgal));
        if (fields.is_given("InstrHeight"))
            reading.height = Metres(fields.number("InstrHeight", -10.0, 10.0));
        reading.position = position(fields, "LatUser", "LonUser", "ElevUser");
        if (!reading.position) reading.position = position(fields, "LatGPS", "LonGPS", "ElevGPS");
        for (const auto& [name, column] : {std::pair("sd_mgal", "StdDev"),
                                           {"tilt_x_arcsec", "X"},
                                           {"tilt_y_arcsec", "Y"},
                                           {"temperature_degc", "SensorTemp"},
                                           {"duration_s", "MeasurDur"},
                                           {"line_name", "Line"},
                                           {"tilt_correction_mgal", "TiltCorr"},
                                           {"temperature_correction_mgal", "TempCorr"},
                                           {"drift_correction_mgal", "DriftCorr"}})
            reading.kept.emplace_back(name, fields.text(column));
        if (!fields.trouble().empty()) return Refusal{fields.trouble()};
        return reading;
    }

    static std::optional<Position> position(Fields& fields, std::string_view latitude,
                                            std::string_view longitude, std::string_view altitude) {
        for (const std::string_view name : {latitude, longitude, altitude})
            if (!fields.is_given(name)) return std::nullopt;
        return Position{Degrees(fields.number(latitude, -90.0, 90.0)),
                        Degrees(fields.number(longitude, -180.0, 360.0)),
                        Metres(fields.number(altitude, -500.0, 9000.0))};
    }

    std::string instrument_;
    std::string names_;  ///< Line of column names; `columns_` refers to it.
    std::vector<std::string_view> columns_;
};

}  // namespace

Format cg6_format() {
    return {"Scintrex CG-6",
            [](std::string_view line) {
                return line.starts_with('/') && trimmed(line.substr(1)) == kCg6Title;
            },
            // Shared, because a copy would refer to the names of the original.
            [] {
                return LineReader([lines = std::make_shared<Cg6Lines>()](std::string_view line) {
                    return (*lines)(line);
                });
            }};
}

}  // namespace a351::corrector::gravimeter
