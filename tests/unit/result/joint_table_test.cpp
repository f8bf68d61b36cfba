#include "corrector/result/joint_table.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::result;

namespace {

SurveyCorrection day_with(double gravity_mgal, std::optional<double> u_mgal) {
    StationValue station;
    station.site = "A";
    station.row_count = 2;
    station.gravity = MilliGal(gravity_mgal);
    if (u_mgal) station.u_gravity = MilliGal(*u_mgal);
    station.reference = MilliGal(979900.0);
    SurveyCorrection day;
    day.stations.push_back(station);
    return day;
}

}  // namespace

TEST_CASE("without an adjustment the surveys are side by side, and no value is joint") {
    SurveyCorrection first = day_with(979901.0, 1.0), second = day_with(979904.0, std::nullopt);
    StationValue other = first.stations.front();
    other.site = "B";
    other.reference.reset();
    other.is_flagged_only = true;
    second.stations.push_back(other);
    const std::vector<RecordedSurvey> surveys{{"mon", "", &first}, {"tue", "", &second}};
    const JointTables tables = joint_tables(surveys, nullptr);
    CHECK(csv_table(joint_columns(), tables.stations) ==
          "site,days,n,gravity_mgal,u_gravity_mgal,reference_mgal,residual_mgal,in_sample\n"
          "A,2,4,,,979900.000000,,1\n"
          "B,1,2,,,,,0\n");
    CHECK(tables.differences.empty());
    const Table table = table_by_survey(tables.stations, surveys, false);
    CHECK(table.headings == std::vector<std::string>{"Station", "Days", "n", "Reference mGal",
                                                     "In sample", "mon", "tue"});
    CHECK(table.alignment.size() == table.headings.size());
    CHECK(table.rows[0][5] == "979901.0 +- 1.0");
    CHECK(table.rows[0][6] == "979904.0");
    CHECK(table.rows[1][5] == "-");
    CHECK(table.rows[1][6] == "979901.0 +- 1.0 *");
}

TEST_CASE("the value of a survey is that without the own reference, if the model gives it") {
    StationValue station = day_with(979901.0, 1.0).stations.front();
    CHECK(day_value(station).gravity.value() == 979901.0);
    CHECK(day_value(station).is_in_sample);
    station.left_out = MilliGal(979902.0);
    station.u_left_out = MilliGal(1.5);
    CHECK(day_value(station).gravity.value() == 979902.0);
    CHECK(day_value(station).u->value() == 1.5);
    CHECK_FALSE(day_value(station).is_in_sample);
    // A station that alone is held has its reference.
    station.left_out.reset();
    station.shared = SharedErrors{{}, false, {{"A", 0.3}}};
    CHECK(day_value(station).gravity.value() == 979900.0);
    CHECK(day_value(station).u->value() == 0.3);
    CHECK(day_value(station).is_in_sample);
}

TEST_CASE("two days share the errors of the unit and of the references that both hold") {
    StationValue a, b;
    CHECK(covariance_mgal2(a, b) == 0.0);
    a.shared = SharedErrors{{0.6, 0.0, 0.0, 0.0, -0.2, 0.0, 0.0, 0.0}, false, {{"C", 0.5}}};
    b.shared =
        SharedErrors{{0.5, 0.0, 0.0, 0.0, 0.3, 0.0, 0.0, 0.0}, false, {{"C", 0.4}, {"D", 1.0}}};
    CHECK(covariance_mgal2(a, b) == Approx(0.5 * 0.4 + 0.6 * 0.5 - 0.2 * 0.3));
    // A day with a calibration has other priors.
    b.shared->is_calibrated = true;
    CHECK(covariance_mgal2(a, b) == Approx(0.5 * 0.4));
}

TEST_CASE("an adjustment gives the joint values, except of stations with marked readings only") {
    SurveyCorrection day = day_with(979901.0, 1.0);
    StationValue other = day.stations.front();
    other.site = "B";
    day.stations.push_back(other);
    JointAdjustment adjustment;
    adjustment.stations.push_back({"A", MilliGal(979900.5), MilliGal(0.4), false});
    const std::vector<RecordedSurvey> surveys{{"mon", "", &day}, {"tue", "", &day}};
    const JointTables tables = joint_tables(surveys, &adjustment);
    REQUIRE(tables.stations.size() == 2);
    CHECK(tables.stations[0].gravity->value() == 979900.5);
    CHECK(tables.stations[0].u_gravity->value() == 0.4);
    CHECK(tables.stations[0].residual->value() == 0.5);
    CHECK_FALSE(tables.stations[0].is_in_sample);
    CHECK(tables.stations[0].day_count == 2);
    CHECK_FALSE(tables.stations[1].gravity.has_value());
    CHECK(tables.differences.empty());
    const Table table = table_by_survey(tables.stations, surveys, true);
    CHECK(table.headings.back() == "tue - joint");
    CHECK(table.rows[0].back() == "0.5");
    CHECK(table.rows[1].back() == "-");
}
