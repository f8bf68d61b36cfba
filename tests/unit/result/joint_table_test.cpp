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
        station.shared = SharedErrors{};
        station.shared->unit_mgal = {0.6, 0.0, 0.0, 0.0, -0.2, 0.0, 0.0, 0.0};
    }
    const auto joint = join_days(days);
    CHECK(joint[0].gravity.value() == Approx(979902.0).epsilon(1e-12));
    CHECK_FALSE(joint[0].is_in_sample);
    CHECK(joint[0].u_gravity->value() == Approx(std::sqrt(0.5 * (1.0 + 0.4))));
    // A day with a calibration has other priors.
    days[1].stations.front().shared->is_calibrated = true;
    CHECK(join_days(days)[0].u_gravity->value() == Approx(std::sqrt(0.5)));
}

TEST_CASE("the uncertainty of a difference is that of the errors that make it", "[survey][joint]") {
    // Errors of two stations on two days as sums of independent errors of variance 1: the unit's
    // scale, a reference, the drifts of both days, and four placements.
    Eigen::Matrix<double, 4, 8> errors;
    errors << 0.5, 0.7, 0.4, 0.0, 1.2, 0.0, 0.0, 0.0,  // first day, A
        -0.8, 0.6, 0.9, 0.0, 0.0, 1.1, 0.0, 0.0,       // first day, B
        0.3, 0.5, 0.0, -0.6, 0.0, 0.0, 1.0, 0.0,       // second day, A
        -0.9, 0.8, 0.0, 0.7, 0.0, 0.0, 0.0, 1.6;       // second day, B
    std::vector<SurveyCorrection> days(2);
    for (Eigen::Index d = 0; d < 2; ++d) {
        SurveyCorrection& day = days[static_cast<std::size_t>(d)];
        const Eigen::MatrixXd of_day = errors.middleRows(2 * d, 2);
        day.covariance = StationCovariance{{"A", "B"}, of_day * of_day.transpose()};
        for (Eigen::Index k = 0; k < 2; ++k) {
            StationValue station;
            station.site = k == 0 ? "A" : "B";
            station.left_out = MilliGal(979900.0 + 10.0 * static_cast<double>(k));
            station.u_left_out = MilliGal(of_day.row(k).norm());
            station.shared = SharedErrors{};
            station.shared->unit_mgal.back() = of_day(k, 0);
            station.shared->references_mgal["C"] = of_day(k, 1);
            day.stations.push_back(station);
        }
    }
    const auto joint = join_days(days);
    const auto differences = joint_differences(days);
    REQUIRE(differences.size() == 1);
    Eigen::Matrix<double, 1, 8> of_a, of_b;
    const auto mean = [&](Eigen::Index k) -> Eigen::Matrix<double, 1, 8> {
        const double first = 1.0 / errors.row(k).squaredNorm(),
                     second = 1.0 / errors.row(2 + k).squaredNorm();
        return (first * errors.row(k) + second * errors.row(2 + k)) / (first + second);
    };
    of_a = mean(0);
    of_b = mean(1);
    CHECK(joint[0].u_gravity->value() == Approx(of_a.norm()));
    CHECK(joint[1].u_gravity->value() == Approx(of_b.norm()));
    CHECK(differences[0].from == "A");
    CHECK(differences[0].difference.value() == Approx(10.0));
    CHECK(differences[0].u.value() == Approx((of_b - of_a).norm()));
    // The adjusted values of a network have another covariance than those without the own datum.
    days[1].own = NetworkPart{};
    CHECK(joint_differences(days).empty());
}

TEST_CASE("a station that alone is held has its reference, and shares its error",
          "[survey][joint]") {
    SurveyCorrection day = day_with(979901.0, std::nullopt);
    day.stations.front().shared = SharedErrors{{}, false, {{"A", 0.3}}};
    StationValue other;
    other.site = "B";
    other.left_out = MilliGal(979950.0);
    other.u_left_out = MilliGal(0.5);
    other.shared = SharedErrors{{}, false, {{"A", 0.3}}};
    day.stations.push_back(other);
    day.covariance = StationCovariance{{"A", "B"}, Eigen::Matrix2d{{0.09, 0.09}, {0.09, 0.25}}};
    const std::vector<SurveyCorrection> days{day, day};
    const auto joint = join_days(days);
    CHECK(joint[0].gravity.value() == 979900.0);
    CHECK(joint[0].u_gravity->value() == Approx(0.3));
    CHECK(joint[0].is_in_sample);
    CHECK(joint[1].u_gravity->value() == Approx(std::sqrt(0.17)));
    // The own errors of both days remain, 0.4 each.
    CHECK(joint_differences(days)[0].u.value() == Approx(0.4 / std::sqrt(2.0)));
}

TEST_CASE("an adjustment replaces the means, except of stations with marked readings only",
          "[survey][joint]") {
    SurveyCorrection day = day_with(979901.0, 1.0);
    StationValue other = day.stations.front();
    other.site = "B";
    day.stations.push_back(other);
    JointAdjustment adjustment;
    adjustment.stations.push_back({"A", MilliGal(979900.5), MilliGal(0.4), false});
    const JointTables tables = joint_tables({day, day}, &adjustment);
    REQUIRE(tables.stations.size() == 2);
    CHECK(tables.stations[0].gravity.value() == 979900.5);
    CHECK(tables.stations[0].u_gravity->value() == 0.4);
    CHECK(tables.stations[0].residual->value() == -0.5);
    CHECK_FALSE(tables.stations[0].is_in_sample);
    CHECK(tables.stations[0].day_count == 2);
    CHECK(tables.stations[1].gravity.value() == 979901.0);
    CHECK(tables.differences.empty());
}
