#include "corrector/gravimeter/survey_tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "corrector/tide/permanent_tide.hpp"
#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/echo.hpp"

namespace a351::corrector::gravimeter {
namespace {

/// Decimals of computed averages, mGal.  Reason: a tenth of the finest resolution of the instruments.
constexpr int kDecimals = 5;

/// Returns the number with few decimals, or an empty cell.
std::string cell(const std::optional<MilliGal>& value) {
    return text::fixed_or(value, kDecimals, "");
}

std::string exact_cell(const std::optional<Metres>& value) {
    return value ? text::shortest(value->value()) : "";
}

/// Returns text of the operator as a cell of a table without quotes.
std::string safe_cell(std::string_view text) {
    std::string safe(text);
    const bool is_utf8 = text::is_utf8(text);
    for (char& letter : safe) {
        if (letter == ',') letter = ';';
        const bool is_ascii = static_cast<unsigned char>(letter) < 0x80;  // char can be unsigned
        if (is_ascii ? letter < ' ' || letter > '~' : !is_utf8) letter = '?';
    }
    return safe;
}

/// The first known position of each site, by its name.
using Positions = std::map<std::string, std::optional<tide::Station>>;

Positions positions_of(const std::vector<Stay>& stays) {
    Positions positions;
    for (const Stay& stay : stays) {
        std::optional<tide::Station>& position = positions[stay.site];
        for (const Reading* const reading : stay.readings)
            if (!position) position = reading->position;
    }
    return positions;
}

/// Returns what gravity at the site of a stay keeps of the permanent tide.
MilliGal kept_tide(const Stay& stay, const Positions& positions, const TableOptions& options) {
    if (!options.tide_system) return MilliGal(0.0);
    if (const auto& position = positions.at(stay.site))
        return tide::kept_permanent_tide(*options.tide_system, *position, {});
    throw InputError(
        fmt::format("--tide-system = {}: {} has no position in the files; allowed: without it, or "
                    "--tide remove and the option of the command table",
                    tide::name_of(*options.tide_system), stay.site));
}

std::string observations_csv(const std::vector<Stay>& stays, const Positions& positions,
                             const TableOptions& options) {
    const std::string system_cell =
        options.tide_system ? fmt::format(",{}", tide::name_of(*options.tide_system)) : "";
    std::string csv = fmt::format(
        "site,occupation,outlier,time_utc,{}acceleration_mgal,temperature_degc,instrument,loop,"
        "instrument_height_m,pressure_hpa,sd_mgal,readings{}\n",
        options.keeps_tide ? "earth_tide_mgal," : "", system_cell.empty() ? "" : ",tide_system");
    for (const Stay& stay : stays) {
        const StayAverage average = average_of(stay, options.average);
        const std::optional<MilliGal>& correction = average.tide_correction;
        if (options.keeps_tide && !correction)
            throw InputError(
                fmt::format("{} ({}): {} removed no tide from its readings; allowed: --tide remove",
                            stay.site, stay.occupation, stay.instrument));
        // The instrument corrects its readings for temperature, so temperature_degc stays empty.
        csv += fmt::format("{},{},0,{},{}{},,{},{},{},,{},{}{}\n", stay.site, stay.occupation,
                           to_rfc3339(average.time),
                           options.keeps_tide
                               ? cell(-*correction - kept_tide(stay, positions, options)) + ","
                               : "",
                           cell(average.value - correction.value_or(MilliGal(0.0))),
                           stay.instrument, stay.loop, exact_cell(stay.readings.front()->height),
                           cell(average.sd), average.count, system_cell);
    }
    return csv;
}

std::string sites_csv(const std::vector<Stay>& stays, const Positions& positions) {
    std::string csv =
        "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal,u_gravity_mgal,gradient_mgal_per_"
        "m\n";
    for (const Stay& stay : stays) {
        if (stay.occupation > 1) continue;  // its site has a row already
        const std::optional<tide::Station>& position = positions.at(stay.site);
        csv += stay.site + (position ? fmt::format(",{},{},{},,,\n",
                                                   text::shortest(position->longitude.value()),
                                                   text::shortest(position->latitude.value()),
                                                   text::shortest(position->height.value()))
                                     : ",,,,,,\n");
    }
    return csv;
}

/// Returns the names of the kept columns of all files, in order of their first appearance.
std::vector<std::string_view> kept_names(const std::vector<GravimeterFile>& files) {
    std::vector<std::string_view> names;
    for (const GravimeterFile& file : files) {
        if (file.readings.empty()) continue;
        for (const auto& [name, text] : file.readings.front().kept)
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
    return names;
}

std::string readings_csv(const std::vector<GravimeterFile>& files, const std::vector<Stay>& stays) {
    std::map<const Reading*, const Stay*> stay_of;
    for (const Stay& stay : stays)
        for (const Reading* const reading : stay.readings) stay_of[reading] = &stay;
    const std::vector<std::string_view> names = kept_names(files);
    std::string csv =
        "file,line,instrument,site,occupation,loop,time_utc,reading_mgal,tide_correction_mgal,dial,"
        "instrument_height_m";
    for (const std::string_view name : names) csv.append(",").append(name);
    csv += '\n';
    for (const GravimeterFile& file : files) {
        for (const Reading& reading : file.readings) {
            const Stay& stay = *stay_of.at(&reading);
            csv += fmt::format(
                "{},{},{},{},{},{},{},{},{},{},{}", safe_cell(file.path.filename().string()),
                reading.line, reading.instrument, reading.site, stay.occupation, stay.loop,
                to_rfc3339(reading.time), text::shortest(reading.value.value()),
                reading.tide_correction ? text::shortest(reading.tide_correction->value()) : "",
                safe_cell(reading.dial), exact_cell(reading.height));
            for (const std::string_view name : names) {
                const auto kept = std::ranges::find(reading.kept, name,
                                                    &decltype(reading.kept)::value_type::first);
                csv += ',';
                if (kept != reading.kept.end()) csv += safe_cell(kept->second);
            }
            csv += '\n';
        }
    }
    return csv;
}

}  // namespace

std::vector<text::NamedText> survey_tables(const std::vector<GravimeterFile>& files,
                                           const std::vector<Stay>& stays,
                                           const TableOptions& options) {
    const Positions positions = positions_of(stays);
    return {{"observations.csv", observations_csv(stays, positions, options)},
            {"sites.csv", sites_csv(stays, positions)},
            {"readings.csv", readings_csv(files, stays)}};
}

}  // namespace a351::corrector::gravimeter
