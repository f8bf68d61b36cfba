#include "corrector/gravimeter/columns.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "protocol/text/echo.hpp"
#include "protocol/text/sites.hpp"

namespace a351::corrector::gravimeter {
namespace {

using enum Form;

/// Limits, in the unit of the field.  Reason: the range of a gravimeter for the whole Earth is
/// 8000 mGal, and no solid-Earth tide exceeds 0.3 mGal; a mark is within 10 m of the instrument.
constexpr double kReading_mgal = 20e3, kTide_mgal = 1.0, kHeight_m = 10.0;
/// Limit of a dial, without unit: real ones are below 10 000, and synthetic files have 50 000.
constexpr double kDial = 99999.0;
/// Limit of numbers that are only kept.  Reason: none of the real files exceeds it, and a cell that
/// ran into the next one does.
constexpr double kKept = 9999999.0;

Column number(std::string_view field, double low, double high, std::vector<ColumnName> names,
              bool is_required = false) {
    return {field, CellType::number, low, high, is_required, false, std::move(names)};
}

Column required(std::string_view field, CellType type, std::vector<ColumnName> names) {
    return {field, type, 0.0, 0.0, true, false, std::move(names)};
}

Column kept(std::string_view field, std::vector<ColumnName> names) {
    return {field, CellType::number, -kKept, kKept, false, true, std::move(names)};
}

Column kept_text(std::string_view field, std::vector<ColumnName> names) {
    return {field, CellType::text, 0.0, 0.0, false, true, std::move(names)};
}

Column unused(std::string_view field, CellType type, std::vector<ColumnName> names) {
    return {field, type, -kKept, kKept, false, false, std::move(names)};
}

std::vector<Column> table() {
    return {
        required("site", CellType::site,
                 {{cg5, "STATION"},
                  {cg6, "Station"},
                  {cg6_lynx, "Station"},
                  {burris, "Station ID"},
                  {gcym, "station"}}),
        required("instrument", CellType::instrument, {{burris, "Serial Number"}, {gcym, "meter"}}),
        required("date", CellType::date, {{cg5, "DATE"}, {cg6, "Date"}, {burris, "Date"}}),
        required("time", CellType::time, {{cg5, "TIME"}, {cg6, "Time"}, {burris, "Time"}}),
        required("minute_of_time", CellType::text, {{gcym, "YYMMDDhhmm"}}),
        number("year", 1900, 2200, {{cg6_tsoft, "Year"}, {cg6_lynx, "Year"}}, true),
        number("month", 1, 12, {{cg6_tsoft, "Month"}, {cg6_lynx, "Month"}}, true),
        number("day", 1, 31, {{cg6_tsoft, "DayOfMonth"}, {cg6_lynx, "DayOfMonth"}}, true),
        number("hour", 0, 23, {{cg6_tsoft, "Hour"}, {cg6_lynx, "Hour"}}, true),
        number("minute", 0, 59, {{cg6_tsoft, "Minute"}, {cg6_lynx, "Minute"}}, true),
        number("second", 0, 59, {{cg6_tsoft, "Second"}, {cg6_lynx, "Second"}}, true),
        number("millisecond", 0, 999, {{cg6_tsoft, "MilliSec"}, {cg6_lynx, "MilliSec"}}),
        number("reading_mgal", -kReading_mgal, kReading_mgal,
               {{cg5, "GRAV."},
                {cg6, "CorrGrav"},
                {cg6_tsoft, "CorrGravity(mGals)"},
                {cg6_lynx, "CorrGravity(mGals)"},
                {burris, "ObsG"},
                {gcym, "reading"}},
               true),
        number("tide_correction_mgal", -kTide_mgal, kTide_mgal,
               {{cg5, "TIDE"},
                {cg6, "TideCorr"},
                {cg6_tsoft, "TidalCorr(mGals)"},
                {cg6_lynx, "TidalCorr(mGals)"},
                {burris, "Earthtide Correction"}},
               true),
        required("applied", CellType::flags, {{cg6, "Corrections[drift-temp-na-tide-tilt]"}}),
        number("dial", 0, kDial, {{burris, "Dial"}}, true),
        number("instrument_height_m", -kHeight_m, kHeight_m,
               {{cg6, "InstrHeight"},
                {cg6_tsoft, "InstHeight(cm)", 0.01},
                {cg6_lynx, "InstHeight(m)"},
                {burris, "Height"}}),
        number("latitude_deg", -90, 90,
               {{cg5, "LAT"},
                {cg6, "LatUser"},
                {cg6_tsoft, "Latitude(DD)"},
                {cg6_lynx, "Latitude(DD)"},
                {burris, "Latitude"}}),
        number("longitude_deg", -180, 360,
               {{cg5, "LONG"},
                {cg6, "LonUser"},
                {cg6_tsoft, "Longitude(DD)"},
                {cg6_lynx, "Longitude(DD)"},
                {burris, "Longitude"}}),
        number("altitude_m", text::kLeastAltitude_m, text::kGreatestAltitude_m,
               {{cg5, "ALT."},
                {cg6, "ElevUser"},
                {cg6_tsoft, "Elevation(m)"},
                {cg6_lynx, "Elevation(m)"},
                {burris, "Elevation"}}),
        number("receiver_latitude_deg", -90, 90,
               {{cg6, "LatGPS"}, {cg6_tsoft, "GPSLat(DD)"}, {cg6_lynx, "GPSLat(DD)"}}),
        number("receiver_longitude_deg", -180, 360,
               {{cg6, "LonGPS"}, {cg6_tsoft, "GPSLong(DD)"}, {cg6_lynx, "GPSLong(DD)"}}),
        number("receiver_altitude_m", text::kLeastAltitude_m, text::kGreatestAltitude_m,
               {{cg6, "ElevGPS"}, {cg6_tsoft, "GPSOrthHgt(m)"}, {cg6_lynx, "GPSOrthHgt(m)"}}),

        kept("sd_mgal", {{cg5, "SD."},
                         {cg6, "StdDev"},
                         {cg6_lynx, "StdDev(mGals)"},
                         {burris, "Standard Deviation"}}),
        kept("se_mgal", {{cg6, "StdErr"}, {cg6_lynx, "StdErr(mGals)"}}),
        kept("tilt_x_arcsec", {{cg5, "TILTX"},
                               {cg6, "X"},
                               {cg6_tsoft, "XLevel(arcsecs)"},
                               {cg6_lynx, "XLevel(arcsecs)"}}),
        kept("tilt_y_arcsec", {{cg5, "TILTY"},
                               {cg6, "Y"},
                               {cg6_tsoft, "YLevel(arcsec)"},
                               {cg6_lynx, "YLevel(arcsec)"}}),
        kept("temperature_degc", {{cg6, "SensorTemp"}}),
        kept("temperature_offset_mk",
             {{cg5, "TEMP"}, {cg6_tsoft, "SensorTemp(dT, mK)"}, {cg6_lynx, "SensorTemp(dT, mK)"}}),
        kept("duration_s", {{cg5, "DUR"}, {cg6, "MeasurDur"}, {cg6_lynx, "Duration"}}),
        kept("rejected", {{cg5, "REJ"}, {cg6_lynx, "Rejected"}}),
        kept_text("line_name", {{cg5, "LINE"}, {cg6, "Line"}, {cg6_lynx, "Line"}}),
        kept_text("stay_number", {{cg6_lynx, "Occupation"}}),
        kept("feedback_mgal", {{burris, "Feedback Correction"}}),
        kept("tilt_correction_mgal", {{cg6, "TiltCorr"},
                                      {cg6_tsoft, "LevelCorr(mGals)"},
                                      {cg6_lynx, "LevelCorr(mGals)"},
                                      {burris, "Level Correction"}}),
        kept("temperature_correction_mgal", {{cg6, "TempCorr"},
                                             {cg6_tsoft, "TempCorr(mGals)"},
                                             {cg6_lynx, "TempCorr(mGals)"},
                                             {burris, "Temperature Correction"}}),
        kept("drift_correction_mgal",
             {{cg6, "DriftCorr"}, {cg6_tsoft, "DriftCorr(mGals)"}, {cg6_lynx, "DriftCorr(mGals)"}}),
        kept("ocean_load_correction_mgal",
             {{cg6_tsoft, "LoadCorr(mGals)"}, {cg6_lynx, "LoadCorr(mGals)"}}),
        kept("terrain_correction_mgal", {{cg5, "TERRAIN"}}),
        kept("beam_error", {{burris, "Beam Error"}}),
        kept("elapsed_time", {{burris, "Elapsed Time"}}),
        kept("temperature_frequency", {{burris, "Temperature Frequency"}}),
        kept("pressure_hpa", {{gcym, "pressure"}}),
        kept("air_temperature_degc", {{gcym, "air temperature"}}),
        kept_text("note", {{burris, "Note"}}),

        // A spreadsheet ends all lines with separators if one line was longer.
        unused("", CellType::text, {{cg6, ""}, {burris, ""}}),
        unused("", CellType::text, {{cg6_lynx, "Survey"}}),
        unused("observer", CellType::text, {{burris, "Observer ID"}}),
        unused("network", CellType::text, {{gcym, "network"}}),
        unused("", CellType::number, {{cg5, "DEC.TIME+DATE"}}),
        unused("", CellType::number, {{cg6, "RawGrav"}, {cg6_tsoft, "RawGravity(mGals)"}}),
        unused("", CellType::number, {{cg6_tsoft, "Battery1"}}),
        unused("", CellType::number, {{cg6_tsoft, "Battery2"}}),
        unused("", CellType::number, {{cg6_tsoft, "CorrStatus"}}),
        unused("", CellType::number, {{cg6_tsoft, "GPSFixQuality"}, {cg6_lynx, "GPSFixQuality"}}),
        unused("", CellType::number, {{cg6_tsoft, "GPSSatellites"}, {cg6_lynx, "GPSSatellites"}}),
        unused("", CellType::number, {{cg6_tsoft, "GPSHDOP"}, {cg6_lynx, "GPSHDOP"}}),
        unused("", CellType::number,
               {{cg6_tsoft, "Gradient(mGals/cm)"}, {cg6_lynx, "Gradient(mGals/cm)"}}),
        unused("", CellType::number, {{cg6_tsoft, "MeterStatus(Byte)"}}),
    };
}

const ColumnName* name_in(const Column& column, Form form) {
    const auto found = std::ranges::find(column.names, form, &ColumnName::form);
    return found == column.names.end() ? nullptr : &*found;
}

/// Adds a name to a list of them.
void add(std::string& list, std::string_view name) {
    list.append(list.empty() ? "" : ", ").append(text::echoed(name));
}

}  // namespace

const std::vector<Column>& columns() {
    static const std::vector<Column> list = table();
    return list;
}

Layout named_layout(Form form, const std::vector<std::string_view>& names,
                    const std::vector<std::string_view>& absent) {
    Layout layout;
    std::string unknown, repeated, missing;
    for (const std::string_view name : names) {
        Layout::Place place{std::string(name)};
        for (const Column& column : columns())
            if (const ColumnName* const known = name_in(column, form);
                known != nullptr && known->name == name)
                place = {std::string(name), &column, known->factor};
        if (place.column == nullptr) add(unknown, name);
        if (!name.empty() &&
            std::ranges::find(layout.places, name, &Layout::Place::name) != layout.places.end())
            add(repeated, name);
        layout.places.push_back(std::move(place));
    }
    for (const Column& column : columns()) {
        const ColumnName* const known = name_in(column, form);
        if (known == nullptr || !column.is_required) continue;
        if (std::ranges::find(absent, column.field) != absent.end()) continue;
        if (std::ranges::find(layout.places, &column, &Layout::Place::column) ==
            layout.places.end())
            add(missing, known->name);
    }
    for (const auto& [what, list] :
         {std::pair("unknown", &unknown), {"repeated", &repeated}, {"missing", &missing}})
        if (!list->empty())
            layout.trouble +=
                fmt::format("{}{} columns: {}", layout.trouble.empty() ? "" : "; ", what, *list);
    layout.description = fmt::format("{} columns, by name", names.size());
    return layout;
}

std::vector<std::string_view> usual_names(Form form) {
    switch (form) {
        case cg5:
            return {"LINE", "STATION", "ALT.", "GRAV.", "SD.",           "TILTX",   "TILTY", "TEMP",
                    "TIDE", "DUR",     "REJ",  "TIME",  "DEC.TIME+DATE", "TERRAIN", "DATE"};
        case cg6:
            return {
                "Station",     "Date",     "Time",       "CorrGrav",
                "Line",        "StdDev",   "StdErr",     "RawGrav",
                "X",           "Y",        "SensorTemp", "TideCorr",
                "TiltCorr",    "TempCorr", "DriftCorr",  "MeasurDur",
                "InstrHeight", "LatUser",  "LonUser",    "ElevUser",
                "LatGPS",      "LonGPS",   "ElevGPS",    "Corrections[drift-temp-na-tide-tilt]"};
        case burris:
            return {"Station ID",
                    "Observer ID",
                    "Serial Number",
                    "Date",
                    "Time",
                    "ObsG",
                    "Dial",
                    "Feedback Correction",
                    "Earthtide Correction",
                    "Level Correction",
                    "Temperature Correction",
                    "Beam Error",
                    "Height",
                    "Elevation",
                    "Latitude",
                    "Longitude",
                    "Elapsed Time",
                    "Standard Deviation",
                    "Temperature Frequency",
                    "Note"};
        case gcym:
            return {"meter",   "network",  "YYMMDDhhmm",     "station",
                    "reading", "pressure", "air temperature"};
        case cg6_lynx:
            return {"Year",
                    "Month",
                    "DayOfMonth",
                    "Hour",
                    "Minute",
                    "Second",
                    "MilliSec",
                    "Survey",
                    "Station",
                    "Occupation",
                    "Line",
                    "Latitude(DD)",
                    "Longitude(DD)",
                    "Elevation(m)",
                    "CorrGravity(mGals)",
                    "StdErr(mGals)",
                    "StdDev(mGals)",
                    "XLevel(arcsecs)",
                    "YLevel(arcsec)",
                    "SensorTemp(dT, mK)",
                    "LevelCorr(mGals)",
                    "TidalCorr(mGals)",
                    "LoadCorr(mGals)",
                    "TempCorr(mGals)",
                    "DriftCorr(mGals)",
                    "GPSLat(DD)",
                    "GPSLong(DD)",
                    "GPSFixQuality",
                    "GPSSatellites",
                    "GPSHDOP",
                    "GPSOrthHgt(m)",
                    "Duration",
                    "Rejected",
                    "InstHeight(m)",
                    "Gradient(mGals/cm)"};
        case cg6_tsoft:
            break;  // it always has names
    }
    return {};
}

Layout usual_layout(Form form, const std::vector<std::string_view>& names,
                    const std::vector<std::string_view>& absent) {
    Layout layout = named_layout(form, names, absent);
    layout.description =
        fmt::format("{} columns in the usual order, without a line of names", names.size());
    return layout;
}

}  // namespace a351::corrector::gravimeter
