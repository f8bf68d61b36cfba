#include "corrector/result/export_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "corrector/judgement/reading_grade.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/json_text.hpp"

namespace a351::corrector::result {
namespace {

using Json = nlohmann::ordered_json;

/// Standard uncertainty used for an occupation if the fit gives none, mGal.  Source: the published
/// scatter of the sensor.
constexpr MilliGal kUnknownScatter{2.0};

/// Rounds to 1e-9; 1e-9 degrees is 0.1 mm.
double rounded(double value) {
    constexpr double kSteps = 1e9;
    return std::round(value * kSteps) / kSteps;
}

Json mgal(const std::optional<MilliGal>& value) {
    constexpr double kSteps = 1e6;
    return value ? Json(std::round(value->value() * kSteps) / kSteps) : Json(nullptr);
}

Json feature(const model::StationValue& station, const text::Site& site,
             const judgement::ReadingGrade& grade) {
    Json json;
    json["type"] = "Feature";
    json["geometry"] = nullptr;
    if (site.is_placed) {
        constexpr double kTurn_deg = 360.0;
        Json place = Json::array({rounded(std::remainder(site.longitude.value(), kTurn_deg)),
                                  rounded(site.latitude.value())});
        if (site.has_altitude) place.push_back(rounded(site.altitude.value()));
        json["geometry"] = {{"type", "Point"}, {"coordinates", place}};
    }
    json["properties"] = {{"site", station.site},
                          {"n", station.row_count},
                          {"gravity_mgal", mgal(station.gravity)},
                          {"u_gravity_mgal", mgal(station.u_gravity)},
                          {"reference_mgal", mgal(station.reference)},
                          {"residual_mgal", mgal(station.residual)},
                          {"flagged_only", station.is_flagged_only},
                          {"grade", judgement::grade_name(grade.grade)},
                          {"grade_reason", judgement::reason_text(grade)}};
    return json;
}

/// Replaces the characters that GSadjust's reader does not accept in names: it splits lines at '/'
/// and ':' before commas, and '%' begins a comment.
std::string gsadjust_name(std::string name) {
    for (char& c : name)
        if (c == '/' || c == ':' || c == '%') c = '-';
    return name;
}

std::string duration_s(const reading::SurveyRow& row) {
    if (!row.start || !row.end) return "0";
    return text::fixed(seconds_between(*row.start, *row.end), 0);
}

}  // namespace

std::string stations_geojson(const model::SurveyCorrection& result,
                             const std::vector<text::Site>& sites) {
    std::string text = "{\"type\": \"FeatureCollection\", \"features\": [";
    const std::vector<judgement::ReadingGrade> grades = judgement::grade_readings(result);
    for (const model::StationValue& station : result.stations) {
        const text::Site* const site = text::find_site(sites, station.site);
        if (site == nullptr) continue;
        text += (text.back() == '[' ? "\n" : ",\n") +
                text::json_text(feature(station, *site,
                                        judgement::grade_of_station(result, grades, station.site)));
    }
    return text + "\n]}\n";
}

std::string gsadjust_csv(const model::SurveyCorrection& result,
                         const std::vector<text::Site>& sites) {
    std::string csv =
        "station,latitude_deg,longitude_deg,altitude_m,gravity_mgal,sd_mgal,tilt_x,tilt_y,"
        "temperature_degc,tide_correction_mgal,duration_s,rejected,time_utc,decimal_date,"
        "terrain_mgal,date_utc\n";
    for (const model::CorrectedRow& row : result.rows) {
        const text::Site* const site = text::find_site(sites, row.row.site);
        if (site == nullptr) continue;
        const std::string time = to_rfc3339(row.row.time);
        const MilliGal u = row.u_corrected.value_or(kUnknownScatter);
        const bool is_kept_out =
            row.row.is_excluded || (row.row.is_flagged && result.options.use_flags);
        const MilliGal gravity = row.row.reduced() + row.temperature_correction +
                                 row.rate_correction + row.tilt_correction_or_zero();
        for (const MilliGal value : {gravity - u, gravity + u}) {
            csv += fmt::format(
                "{}{},{},{},{},{},{},0,0,{},{},{},0,{},0,0,{}/{}/{}\n", is_kept_out ? "% " : "",
                gsadjust_name(row.row.site), text::fixed(site->latitude.value(), 7),
                text::fixed(site->longitude.value(), 7), text::fixed(site->altitude.value(), 3),
                text::fixed(value.value(), 6), text::fixed(u.value(), 6),
                text::fixed(row.row.temperature.value(), 4), text::fixed(-row.row.tide.value(), 6),
                duration_s(row.row), time.substr(11, 8), time.substr(5, 2), time.substr(8, 2),
                time.substr(0, 4));
        }
    }
    return csv;
}

std::vector<text::NamedText> export_files(const model::SurveyCorrection& result,
                                          const std::vector<text::Site>& sites) {
    std::vector<text::NamedText> files{{"stations.geojson", stations_geojson(result, sites)}};
    // The readings of a file for GSadjust have one constant.
    const auto constant_of = [](const model::CorrectedRow& row) {
        return std::pair(row.row.instrument, row.row.loop);
    };
    if (std::ranges::adjacent_find(result.rows, std::not_equal_to{}, constant_of) ==
        result.rows.end())
        files.push_back({"gsadjust.csv", gsadjust_csv(result, sites)});
    return files;
}

}  // namespace a351::corrector::result
