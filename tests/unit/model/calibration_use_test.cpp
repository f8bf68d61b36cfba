#include "corrector/model/calibration_use.hpp"

#include <nlohmann/json.hpp>
#include <sstream>

#include "corrector/result/result_files.hpp"
#include "tests/unit/model/corrections.hpp"
#include "tests/unit/model/rows_of_day.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;
using namespace a351::corrector::result;
using namespace a351::corrector::whole_day;
using namespace a351::unit;

namespace {

/// Returns the rows of the day with the means of x, and readings for a linear model.
std::vector<SurveyRow> tilted_rows_of(const DayRecord& day) {
    std::vector<SurveyRow> rows = rows_of(day);
    for (std::size_t s = 0; s < rows.size(); ++s) {
        SurveyRow& row = rows[s];
        const double x_g = day.bins[s * MadeUpDay::kBins].x.value();
        row.record.emplace().x.mean = StandardGravity(x_g);
        row.acceleration = *row.reference + MilliGal(1838.0 + kScattered.x * x_g) -
                           MilliGal(30.0 * (row.temperature.value() - 42.6));
    }
    return rows;
}

Calibration calibration(double x_mgal_per_g = kScattered.x) {
    Calibration known;
    known.serial_number = "7";
    known.program = "a351-correct 0";
    known.valid_from = MadeUpDay::start();
    known.axis_bias = AxisBias{{x_mgal_per_g, 0.0}, Eigen::Vector2d(400.0, 400.0).asDiagonal()};
    return known;
}

ThermalResponse thermal(const MadeUpDay& day) {
    ThermalResponse response;
    response.values << day.level, day.slow, day.fast, std::log(day.fast_lag_s),
        std::log(day.slow_lag_s);
    response.covariance = Eigen::Matrix<double, 5, 1>(4.0, 4.0, 0.2, 0.003, 0.01).asDiagonal();
    return response;
}

SurveyOptions with(const Calibration& known, const std::string& model) {
    return {.model = model, .calibration = known};
}

bool has_remark(const SurveyCorrection& result, const std::string& part) {
    return std::ranges::any_of(result.remarks, [&part](const std::string& remark) {
        return remark.find(part) != std::string::npos;
    });
}

}  // namespace

TEST_CASE("a thermal response is used with twice its errors, axis biases with their own errors") {
    Calibration known = calibration();
    known.thermal = thermal(kScattered);
    const DayPriors priors = day_priors_of(known);
    const DayPriors::Matrix covariance = priors.factor * priors.factor.transpose();
    const auto variance = [&](DayTerm term) {
        return covariance(DayPriors::place_of(term), DayPriors::place_of(term));
    };
    // Combined with the usual prior, whose deviation is 7.2, and with that of free_axes().
    CHECK(variance(DayTerm::level) == Approx(1.0 / (1.0 / 16.0 + 1.0 / (7.2 * 7.2))));
    CHECK(covariance(0, 0) == Approx(1.0 / (1.0 / 0.012 + 1.0 / std::pow(std::log(1.5), 2))));
    CHECK(variance(DayTerm::x) == Approx(400.0).epsilon(1e-3));
    CHECK(priors.mean(DayPriors::place_of(DayTerm::x)) == Approx(900.0).epsilon(1e-3));
    CHECK(variance(DayTerm::drift) == Approx(1.0));
}

TEST_CASE("a day agrees with the calibration of its unit and contradicts that of another unit") {
    const DayRecord day = kScattered.record();
    const auto rows = tilted_rows_of(day);
    Calibration known = calibration();
    known.thermal = thermal(kScattered);
    const auto own = correct_with_calibration(rows, with(known, "day"), &day);
    REQUIRE(own.model == "day");
    REQUIRE(own.calibration);
    CHECK(own.calibration->is_prior);
    CHECK(own.calibration->axis_bias.value().p > kContradictionP);
    CHECK(own.calibration->axis_bias->dof == 1);  // y is never tilted
    CHECK(own.calibration->thermal.value().p > kContradictionP);
    CHECK(has_remark(own, "calibration of unit 7"));
    CHECK_FALSE(has_remark(own, "contradict"));
    CHECK_FALSE(has_remark(own, "the survey is worse"));
    CHECK(calibration_json(own)["worse_with_it"] == false);
    REQUIRE(own.calibration->loso_without_mgal);
    CHECK(*own.calibration->loso_without_mgal >= *own.score.loso_mgal);

    known.axis_bias->values(0) = -900.0;
    const auto turned = correct_with_calibration(rows, with(known, "day"), &day);
    CHECK(has_remark(turned, "contradict the calibration's axis biases"));
    CHECK_FALSE(has_remark(turned, "contradict the calibration's thermal response"));
    CHECK(calibration_json(turned)["axis_bias"]["contradicted"] == true);
    CHECK(calibration_json(turned)["thermal"]["use"] == "prior");
    CHECK(turned.calibration->loso_without_mgal == own.calibration->loso_without_mgal);
    CHECK(has_remark(turned, "the survey is worse: stations left out"));
    CHECK(calibration_json(turned)["worse_with_it"] == true);

    known = calibration();
    known.thermal = thermal(MadeUpDay{.level = 5.0, .slow = -45.0, .fast = 16.0});
    const auto other = correct_with_calibration(rows, with(known, "day"), &day);
    CHECK(has_remark(other, "contradict the calibration's thermal response"));
}

TEST_CASE("a wrong calibration is contradicted however small its stated errors are") {
    const DayRecord day = kScattered.record();
    const auto rows = tilted_rows_of(day);
    for (const double variance : {221.0, 110.0, 1.0, 0.01}) {
        CAPTURE(variance);
        Calibration known =
            calibration(kScattered.x + 5000.0);  // 10 mGal where the tilt is 0.1 deg
        known.axis_bias->covariance = Eigen::Vector2d(variance, variance).asDiagonal();
        const auto result = correct_with_calibration(rows, with(known, "day"), &day);
        REQUIRE(result.calibration->axis_bias);
        CHECK(result.calibration->axis_bias->p < kContradictionP);
        CHECK(has_remark(result, "contradict the calibration's axis biases"));
    }
}

TEST_CASE("a calibration is not tested if the day has no information about it") {
    DayRecord day = kScattered.record();
    for (DayBin& bin : day.bins) bin.x = StandardGravity(0.0);
    Calibration known = calibration();
    known.thermal = thermal(kScattered);
    const auto result = correct_with_calibration(tilted_rows_of(day), with(known, "day"), &day);
    CHECK_FALSE(result.calibration->axis_bias);
    CHECK(calibration_json(result)["axis_bias"]["contradicted"].is_null());
    CHECK(calibration_json(result)["thermal"]["contradicted"] == false);
    CHECK(has_remark(result, "axis biases not tested"));
    CHECK_FALSE(has_remark(result, "thermal response not tested"));
}

TEST_CASE("with a calibration one datum is enough for the whole-day model") {
    const DayRecord day = kScattered.record();
    auto rows = tilted_rows_of(day);
    know_only(rows, {"S0"});
    const auto result = correct_with_calibration(rows, with(calibration(), "auto"), &day);
    CHECK(result.model == "day");
    for (const StationValue& station : result.stations) {
        CHECK(station.gravity.value() == Approx(gravity_of(station.site)).epsilon(0.0).margin(6.0));
    }
}

TEST_CASE("other models use readings that are corrected for tilt") {
    const auto rows = tilted_rows_of(kScattered.record());
    const auto result = correct_with_calibration(rows, with(calibration(), "t"), nullptr);
    CHECK(result.score.rms_mgal.value() < 1e-6);
    CHECK(correct_survey(rows, with(calibration(), "t")).score.rms_mgal.value() > 0.5);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const CorrectedRow& row = result.rows[i];
        CHECK(row.row.acceleration == rows[i].acceleration);
        CHECK(row.difference.value().value() ==
              Approx((rows[i].acceleration - *rows[i].reference).value()));
        CHECK(sum_mgal(row) == Approx(row.corrected.value()).epsilon(1e-12));
    }
    REQUIRE(result.calibration);
    CHECK_FALSE(result.calibration->is_prior);
    CHECK(calibration_json(result)["axis_bias"]["use"] == "fixed");
    CHECK(calibration_json(result)["axis_bias"]["contradicted"].is_null());
    CHECK(calibration_json(result)["thermal"].is_null());
    CHECK(calibration_json(correct_survey(rows, by_model("t"))).is_null());
}

TEST_CASE("a row without the mean of an axis is refused if a bias must be subtracted") {
    auto rows = tilted_rows_of(kScattered.record());
    rows[3].record.reset();
    CHECK_THROWS_WITH(correct_with_calibration(rows, with(calibration(), "t"), nullptr),
                      "calibration: S3 (1) has no mean_x_g; allowed: rows from records");
    Calibration known = calibration();
    known.axis_bias.reset();
    known.thermal = thermal(kScattered);
    CHECK_NOTHROW(correct_with_calibration(rows, with(known, "t"), nullptr));
}

TEST_CASE("models.csv shows how each score uses the calibration") {
    const DayRecord day = kScattered.record();
    const auto rows = tilted_rows_of(day);
    const auto uses = [&](const SurveyCorrection& result) {
        std::map<std::string, std::string> of_model;
        std::istringstream lines(models_csv(result));
        std::string line;
        std::getline(lines, line);
        CHECK(line.ends_with(",dof,calibration"));
        while (std::getline(lines, line))
            of_model[line.substr(0, line.find(','))] = line.substr(line.rfind(',') + 1);
        return of_model;
    };
    const auto by_day = uses(correct_with_calibration(rows, with(calibration(), "day"), &day));
    CHECK(by_day.at("day") == "prior");
    CHECK(by_day.at("t") == "fixed");
    const auto fixed = correct_with_calibration(rows, with(calibration(), "t"), nullptr);
    CHECK(uses(fixed).at("paper") == "fixed");
    CHECK(uses(correct_survey(rows, {})).at("paper") == "none");
    CHECK(has_remark(fixed, "the scores of all models too"));
}

TEST_CASE("fitted and calibrated axis biases together give one tilt correction") {
    auto rows = tilted_rows_of(kScattered.record());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double y_g = 0.001 * static_cast<double>(i * i % 5);
        rows[i].rate_degc_per_h = 0.01 * static_cast<double>(i * i % 3);
        rows[i].record->y.mean = StandardGravity(y_g);
    }
    const auto result =
        correct_with_calibration(rows, with(calibration(), "t-rate-drift-axes"), nullptr);
    for (const CorrectedRow& row : result.rows) {
        REQUIRE(row.tilt_correction);
        CHECK(sum_mgal(row) == Approx(row.corrected.value()).epsilon(1e-12));
    }
}
