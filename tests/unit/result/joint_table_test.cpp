#include "corrector/result/joint_table.hpp"

#include <cmath>
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

TEST_CASE("days are combined by their weights", "[survey][joint]") {
    const auto joint = join_days({day_with(979901.0, 1.0), day_with(979904.0, 2.0)});
    REQUIRE(joint.size() == 1);
    CHECK(joint[0].gravity.value() == Approx(979901.6).epsilon(1e-12));
    CHECK(joint[0].u_gravity->value() == Approx(std::sqrt(0.8)));
    CHECK(joint[0].residual->value() == Approx(-1.6));
    CHECK(joint[0].day_count == 2);
    CHECK(joint[0].row_count == 4);
}

TEST_CASE("if a day has no uncertainty the plain mean of the days is used", "[survey][joint]") {
    const auto joint = join_days({day_with(979901.0, 1.0), day_with(979904.0, std::nullopt)});
    CHECK(joint[0].gravity.value() == Approx(979902.5).epsilon(1e-12));
    CHECK_FALSE(joint[0].u_gravity.has_value());
    CHECK(csv_table(joint_columns(), joint) ==
          "site,days,n,gravity_mgal,u_gravity_mgal,reference_mgal,residual_mgal,in_sample\n"
          "A,2,4,979902.500000,,979900.000000,-2.500000,1\n");
}

TEST_CASE("days are joined by their values without the own reference, with the errors they share",
          "[survey][joint]") {
    std::vector<SurveyCorrection> days{day_with(979900.0, 1.0), day_with(979900.0, 1.0)};
    for (SurveyCorrection& day : days) {
        StationValue& station = day.stations.front();
        station.left_out = MilliGal(979902.0);
        station.u_left_out = MilliGal(1.0);
        station.errors = StationErrors{};
        station.errors->shared_mgal = {0.6, 0.0, 0.0, 0.0, -0.2, 0.0, 0.0};
    }
    const auto joint = join_days(days);
    CHECK(joint[0].gravity.value() == Approx(979902.0).epsilon(1e-12));
    CHECK_FALSE(joint[0].is_in_sample);
    CHECK(joint[0].u_gravity->value() == Approx(std::sqrt(0.5 * (1.0 + 0.4))));
    // A day with a calibration has other priors.
    days[1].stations.front().errors->is_calibrated = true;
    CHECK(join_days(days)[0].u_gravity->value() == Approx(std::sqrt(0.5)));
}
