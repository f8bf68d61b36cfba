#include "corrector/job/survey_readings.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::job;
using namespace a351::corrector::reading;
using namespace a351::unit;

TEST_CASE("a calibration of another unit is refused, an old one gives a remark") {
    const UtcTime start = parse_rfc3339("2026-03-01T00:00:00Z").value();
    Calibration known;
    known.serial_number = "7";
    known.valid_from = start;
    SurveyFile survey;
    survey.path = "day.toml";
    survey.calibration = "unit.toml";
    survey.survey.calibration = known;
    const std::vector<OccupationWindow> windows{
        {{"S0"}, start + std::chrono::hours(1), start + std::chrono::hours(2)}};
    CHECK(check_calibration(survey, "7", windows).empty());
    CHECK_THROWS_WITH(check_calibration(survey, "8", windows),
                      "day.toml: calibration = unit.toml: of unit 7, the record is of unit 8; "
                      "allowed: a calibration of 8");
    CHECK(check_calibration(survey, "", windows).size() == 1);
    survey.survey.calibration->valid_to = start + std::chrono::minutes(90);
    CHECK(check_calibration(survey, "7", windows).size() == 1);
    survey.survey.calibration->valid_to.reset();
    survey.survey.calibration->valid_from = start + std::chrono::minutes(61);
    CHECK(check_calibration(survey, "7", windows).size() == 1);
}
