#include "corrector/result/export_files.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::result;

namespace {

const std::vector<text::Site> kSites{
    {"A/1", Degrees(282.1414), Degrees(40.7914), Metres(370.0), MilliGal(979900.0)},
    {"B", Degrees(140.1), Degrees(36.1), Metres(20.0), std::nullopt, false}};

/// Returns two occupations with round numbers, the second flagged.
SurveyCorrection small_survey() {
    SurveyCorrection result;
    CorrectedRow row;
    row.row.site = "A/1";
    row.row.time = parse_rfc3339("2020-05-01T09:08:07.9Z").value();
    row.row.start = row.row.time - std::chrono::seconds(300);
    row.row.end = row.row.time + std::chrono::seconds(300);
    row.row.temperature = DegC(42.5);
    row.row.tide = MilliGal(-0.054);
    row.row.acceleration = MilliGal(979899.646);
    row.temperature_correction = MilliGal(0.05);
    row.corrected = MilliGal(979900.25);
    row.drift_correction = MilliGal(0.5);
    row.u_corrected = MilliGal(1.5);
    result.rows.push_back(row);
    row.row.site = "B";
    row.row.is_flagged = true;
    row.row.start.reset();
    row.u_corrected.reset();
    result.rows.push_back(row);
    StationValue station;
    station.site = "A/1";
    station.row_count = 1;
    station.gravity = MilliGal(979900.25);
    station.u_gravity = MilliGal(1.25);
    station.reference = MilliGal(979900.0);
    station.residual = MilliGal(-0.25);
    result.stations.push_back(station);
    station = {};
    station.site = "B";
    station.row_count = 1;
    station.is_flagged_only = true;
    station.gravity = MilliGal(979800.1);
    result.stations.push_back(station);
    return result;
}

}  // namespace

TEST_CASE(
    "stations are exported as points with altitude and a longitude from -180 to 180 degrees east") {
    const std::string text = stations_geojson(small_survey(), kSites);
    CHECK(text ==
          R"({"type": "FeatureCollection", "features": [
{"type":"Feature","geometry":{"type":"Point","coordinates":[-77.8586,40.7914,370.0]},"properties":)"
          R"({"site":"A/1","n":1,"gravity_mgal":979900.25,"u_gravity_mgal":1.25,"reference_mgal":)"
          R"(979900.0,"residual_mgal":-0.25,"flagged_only":false,"grade":"trust",)"
          R"("grade_reason":""}},
{"type":"Feature","geometry":null,"properties":{"site":"B","n":1,"gravity_mgal":979800.1,)"
          R"("u_gravity_mgal":null,"reference_mgal":null,"residual_mgal":null,"flagged_only":true,)"
          R"("grade":"repeat","grade_reason":"B (1): marked by the operator as not to be used"}}
]}
)");
    CHECK(nlohmann::json::parse(text)["features"].size() == 2);
}

TEST_CASE("GSadjust gets the value before the drift step, and the tide correction to be added") {
    const std::string csv = gsadjust_csv(small_survey(), kSites);
    CHECK(csv ==
          "station,latitude_deg,longitude_deg,altitude_m,gravity_mgal,sd_mgal,tilt_x,tilt_y,"
          "temperature_degc,tide_correction_mgal,duration_s,rejected,time_utc,decimal_date,"
          "terrain_mgal,date_utc\n"
          "A-1,40.7914000,282.1414000,370.000,979898.250000,1.500000,0,0,42.5000,0.054000,600,0,"
          "09:08:07,0,0,05/01/2020\n"
          "A-1,40.7914000,282.1414000,370.000,979901.250000,1.500000,0,0,42.5000,0.054000,600,0,"
          "09:08:07,0,0,05/01/2020\n"
          "% B,36.1000000,140.1000000,20.000,979897.750000,2.000000,0,0,42.5000,0.054000,0,0,"
          "09:08:07,0,0,05/01/2020\n"
          "% B,36.1000000,140.1000000,20.000,979901.750000,2.000000,0,0,42.5000,0.054000,0,0,"
          "09:08:07,0,0,05/01/2020\n");
}

TEST_CASE("GSadjust gets readings corrected for tilt, but not for flicker and drift") {
    SurveyCorrection result = small_survey();
    result.rows.front().tilt_correction = MilliGal(2.0);
    result.rows.front().corrected =
        MilliGal(979910.0);  // the flicker correction of the model is not exported
    CHECK_THAT(gsadjust_csv(result, kSites), ContainsSubstring(",979900.250000,1.500000,") &&
                                                 ContainsSubstring(",979903.250000,1.500000,"));
}
