#include "corrector/model/outlier_tests.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

#include "corrector/model/survey_correction.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;

namespace {

/// Returns the made-up day with a scatter of 1 mGal.
std::vector<SurveyRow> scattered_day() {
    auto rows = made_up::day();
    const double alternating[] = {1, -1, 1, 1, -1, -1, 1, -1, 1, 1, -1, -1};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].acceleration = rows[i].acceleration + MilliGal(alternating[i]);
    }
    return rows;
}

std::vector<std::string> statistical_doubts(const std::vector<SurveyRow>& rows,
                                            const std::string& model = "t-rate-drift") {
    SurveyOptions options;
    options.model = model;
    std::vector<std::string> doubts;
    for (const CorrectedRow& row : correct_survey(rows, options).rows) {
        if (row.doubt_statistical.empty()) continue;
        doubts.push_back(row.row.site + " (" + std::to_string(row.row.occupation) + ')');
    }
    return doubts;
}

}  // namespace

TEST_CASE("rate, shape with range, fallback and pulse give physical doubts that state their value",
          "[survey][outlier_tests]") {
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

TEST_CASE("the limit of the test divides the risk by the number of rows",
          "[survey][outlier_tests]") {
    // Table of Student-t: 0.025 / 1 at 10 degrees of freedom, and 0.0025 (n = 10) at 20.
    CHECK(studentised_limit(1, 10.0) == Approx(2.228).margin(0.001));
    CHECK(studentised_limit(10, 20.0) == Approx(3.153).margin(0.001));
}

TEST_CASE("two blunders are found one after the other, and clean rows are not doubted",
          "[survey][outlier_tests]") {
    auto rows = scattered_day();
    CHECK(statistical_doubts(rows).empty());
    rows[2].acceleration = rows[2].acceleration + MilliGal(60.0);
    rows[8].acceleration = rows[8].acceleration - MilliGal(12.0);
    CHECK(statistical_doubts(rows) == std::vector<std::string>{"S2 (1)", "S7 (1)"});
}

TEST_CASE("a row that is not in the fit is tested against it", "[survey][outlier_tests]") {
    auto rows = scattered_day();
    rows[2].acceleration = rows[2].acceleration + MilliGal(60.0);
    rows[2].is_flagged = true;
    rows[3].is_flagged = true;
    CHECK(statistical_doubts(rows) == std::vector<std::string>{"S2 (1)"});
}

TEST_CASE("a network finds a blunder at a station that was read twice or more",
          "[survey][outlier_tests]") {
    auto rows = scattered_day();
    std::vector<SurveyRow> twice;  // every station again, so that the network is controlled
    for (const SurveyRow& row : rows) {
        for (const int shift_min : {0, 5, 10}) {
            twice.push_back(row);
            twice.back().time = row.time + std::chrono::minutes(shift_min);
            twice.back().acceleration = row.acceleration + MilliGal(0.1 * shift_min);
        }
    }
    CHECK(statistical_doubts(twice, "network").empty());
    twice[10].acceleration = twice[10].acceleration + MilliGal(40.0);
    CHECK(statistical_doubts(twice, "network") == std::vector<std::string>{"S3 (1)"});
}

TEST_CASE("doubtful rows stay in the fit", "[survey][outlier_tests]") {
    auto rows = scattered_day();
    rows[2].acceleration = rows[2].acceleration + MilliGal(60.0);
    SurveyOptions options;
    options.model = "t-rate-drift";
    const SurveyCorrection result = correct_survey(rows, options);
    CHECK_FALSE(result.rows[2].doubt_statistical.empty());
    CHECK(result.rows[2].is_used);
    CHECK(result.score.row_count == 12);
}
