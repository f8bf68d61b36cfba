#include <random>

#include "tests/unit/model/corrections.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;

namespace {

/// Returns the made-up day with noise of 1 mGal.
std::vector<SurveyRow> noisy_day(std::uint64_t seed) {
    auto rows = made_up::day();
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    for (SurveyRow& row : rows) add(row, normal(random));
    return rows;
}

SurveyCorrection corrected(const std::vector<SurveyRow>& rows, const std::string& model) {
    SurveyOptions options = by_model(model);
    options.priors.reading_sd_mgal = 1.0;
    return correct_survey(rows, options);
}

const StationDifference& difference_of(const SurveyCorrection& result, const std::string& from,
                                       const std::string& to) {
    for (const StationDifference& one : result.differences)
        if (one.from == from && one.to == to) return one;
    FAIL("no difference from " << from << " to " << to);
    return result.differences.front();
}

}  // namespace

TEST_CASE("a linear model gives the differences that it gives without both references") {
    auto rows = noisy_day(3);
    const SurveyCorrection all = corrected(rows, "t-drift");
    CHECK(all.differences.size() == 8 * 7 / 2);
    const StationDifference found = difference_of(all, "S1", "S4");
    CHECK(found.reference->value() == Approx(21.0));
    for (SurveyRow& row : rows)
        if (row.site == "S1" || row.site == "S4") row.reference.reset();
    const SurveyCorrection hidden = corrected(rows, "t-drift");
    const auto& stations = hidden.stations;
    CHECK(found.difference.value() ==
          Approx((stations[4].gravity - stations[1].gravity).value()).margin(1e-9));
    CHECK_FALSE(difference_of(hidden, "S1", "S4").reference);
    // The uncertainty is that of the fit without both stations, with the s of all rows.
    const double larger = hidden.score.s_mgal.value() / all.score.s_mgal.value();
    CHECK(difference_of(hidden, "S1", "S4").u.value() ==
          Approx(larger * found.u.value()).epsilon(1e-12));
    // Both are unknown, so the covariance of the station values gives the same.
    const Eigen::MatrixXd& c = hidden.covariance.value().mgal2;
    CHECK(std::sqrt(c(1, 1) + c(4, 4) - 2.0 * c(1, 4)) ==
          Approx(larger * found.u.value()).epsilon(1e-9));
    CHECK(stations[1].left_out.value() == stations[1].gravity);
    CHECK(stations[1].coverage_factor.value() == Approx(2.365).epsilon(1e-3));  // t of 7 degrees
}

TEST_CASE("values without the own reference have the error that is stated") {
    const std::string model = GENERATE("t-rate-drift", "network");
    CAPTURE(model);
    double of_stations = 0.0, of_differences = 0.0;
    int station_count = 0, difference_count = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const SurveyCorrection result = corrected(noisy_day(seed), model);
        for (const StationValue& station : result.stations) {
            of_stations += std::pow(
                (*station.left_out - *station.reference).value() / station.u_left_out->value(), 2);
            ++station_count;
        }
        if (model == "network") continue;  // its differences use the references
        for (const StationDifference& one : result.differences) {
            of_differences +=
                std::pow((one.difference - *one.reference).value() / one.u.value(), 2);
            ++difference_count;
        }
    }
    INFO("e/u " << std::sqrt(of_stations / station_count));
    CHECK(std::sqrt(of_stations / station_count) > 0.85);
    CHECK(std::sqrt(of_stations / station_count) < 1.4);  // s of few rows: Student's t
    if (difference_count > 0) {
        CHECK(std::sqrt(of_differences / difference_count) > 0.85);
        CHECK(std::sqrt(of_differences / difference_count) < 1.4);
    }
}

TEST_CASE("a network holds each reference with its own uncertainty") {
    auto rows = noisy_day(5);
    for (SurveyRow& row : rows)
        if (row.site == "S3") {
            row.reference = *row.reference + MilliGal(10.0);
            row.u_reference = MilliGal(30.0);
        }
    const SurveyCorrection result = corrected(rows, "network");
    const StationValue& loose = result.stations[3];
    CHECK(loose.site == "S3");
    CHECK(std::abs(loose.residual->value() + 10.0) < 3.0);
    CHECK(loose.u_gravity->value() > 0.5);
    CHECK(result.stations[1].u_gravity->value() < 0.02);
}
