#include "corrector/judgement/physical_doubt.hpp"

#include "corrector/model/survey_correction.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351;
using namespace a351::corrector::judgement;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;

namespace {

/// Student's t with 7 degrees of freedom (12 rows less 4 coefficients less 1) at 0.05 / 24.
constexpr double kStudentLimit = 4.17;

/// Returns the made-up day with a scatter of 1 mGal.
std::vector<SurveyRow> scattered_day() {
    return made_up::day_with_errors({1, -1, 1, 1, -1, -1, 1, -1, 1, 1, -1, -1});
}

/// Returns the rows whose studentised residual is beyond a limit.
std::vector<std::string> beyond(const std::vector<SurveyRow>& rows, double limit,
                                const std::string& model = "t-rate-drift") {
    SurveyOptions options{.model = model};
    std::vector<std::string> names;
    for (const CorrectedRow& row : correct_survey(rows, options).rows)
        if (std::abs(row.studentised_residual.value_or(0.0)) > limit)
            names.push_back(row.row.site + " (" + std::to_string(row.row.occupation) + ')');
    return names;
}

}  // namespace

TEST_CASE(
    "rate, shape with range, fallback and pulse give physical doubts that state their value") {
    SurveyRow row;
    row.rate_degc_per_h = -0.2;
    CHECK(physical_doubt(row).empty());
    row.rate_degc_per_h = -0.201;
    CHECK(physical_doubt(row) == "rate -0.201 degC/h");
    row.notes = {"disturbed_end", "pulse", "fallback"};
    CHECK(physical_doubt(row) == "rate -0.201 degC/h;pulse;fallback");

    SurveyRow shaped;
    RecordSummary& record = shaped.record.emplace();
    record.temperature_range = DegC(0.06);
    record.temperature_shape = TemperatureShape::turning;
    CHECK(physical_doubt(shaped).empty());
    record.temperature_shape = TemperatureShape::half_wave;
    CHECK(physical_doubt(shaped) == "half a wave of 0.060 degC");
    record.temperature_shape = TemperatureShape::monotone;
    CHECK(physical_doubt(shaped) == "monotone over 0.060 degC");
    record.temperature_range = DegC(0.05);
    CHECK(physical_doubt(shaped).empty());
}

TEST_CASE("a blunder alone has a large studentised residual, in the fit or not") {
    auto rows = scattered_day();
    CHECK(beyond(rows, kStudentLimit).empty());
    add(rows[2], 60.0);
    CHECK(beyond(rows, kStudentLimit) == std::vector<std::string>{"S2 (1)"});
    rows[2].is_flagged = true;
    rows[3].is_flagged = true;
    CHECK(beyond(rows, kStudentLimit) == std::vector<std::string>{"S2 (1)"});
}

TEST_CASE("a network shows a blunder at a station that was read several times") {
    std::vector<SurveyRow> thrice;  // every station again, so that the network is controlled
    for (const SurveyRow& row : scattered_day())
        for (const int shift_min : {0, 5, 10}) {
            thrice.push_back(row);
            thrice.back().time += std::chrono::minutes(shift_min);
            add(thrice.back(), 0.1 * shift_min);
        }
    constexpr double kLimit = 3.6;  // Student's t with many degrees of freedom at 0.05 / 72
    CHECK(beyond(thrice, kLimit, "network").empty());
    add(thrice[10], 40.0);
    CHECK(beyond(thrice, kLimit, "network") == std::vector<std::string>{"S3 (1)"});
}
