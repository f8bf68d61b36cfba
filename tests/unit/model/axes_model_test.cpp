// Least squares with the means of the horizontal axes.
#include <cmath>
#include "tests/support/catch.hpp"

#include "corrector/model/survey_correction.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/unit/model/survey_rows.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;

namespace {

constexpr double kX_mgal_per_g = 1500.0;
constexpr double kY_mgal_per_g = -800.0;

/// Returns the made-up day with a different tilt of the box in each row.
std::vector<SurveyRow> tilted_day() {
    auto rows = made_up::day();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double x_g = 0.002 * std::sin(2.3 * static_cast<double>(i));
        const double y_g = 0.002 * std::cos(3.1 * static_cast<double>(i));
        RecordSummary& record = rows[i].record.emplace();
        record.x.mean = StandardGravity(x_g);
        record.y.mean = StandardGravity(y_g);
        rows[i].acceleration =
            rows[i].acceleration + MilliGal(kX_mgal_per_g * x_g + kY_mgal_per_g * y_g);
    }
    return rows;
}

SurveyOptions with_axes() {
    SurveyOptions options;
    options.model = "t-rate-drift-axes";
    return options;
}

}  // namespace

TEST_CASE("the fit finds the biases of the horizontal axes with temperature, rate and drift",
          "[survey][axes_model]") {
    const auto result = correct_survey(tilted_day(), with_axes());
    const std::vector<std::pair<std::string, double>> expected{
        {"constant_mgal", made_up::kConstant_mgal},
        {"temperature_mgal_per_degc", made_up::kTemperature_mgal_per_degc},
        {"rate_mgal_per_degc_per_h", made_up::kRate_mgal_per_degc_per_h},
        {"time_mgal_per_h", made_up::kDrift_mgal_per_h},
        {"x_mgal_per_g", kX_mgal_per_g},
        {"y_mgal_per_g", kY_mgal_per_g}};
    REQUIRE(result.coefficients.size() == expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
        CHECK(result.coefficients[k].name == expected[k].first);
        // Readings are rounded to 1.2e-10 mGal; the axes differ by some 1e-3 g.
        CHECK(result.coefficients[k].value ==
              Approx(expected[k].second).epsilon(0).margin(k < 4 ? 1e-8 : 1e-6));
    }
    for (const CorrectedRow& row : result.rows) {
        CHECK(row.residual->value() == Approx(0.0).margin(1e-8));
        const MilliGal sum = row.row.reduced() + row.temperature_correction + row.rate_correction +
                             row.drift_correction + row.tilt_correction.value();
        CHECK(sum.value() == Approx(row.corrected.value()).epsilon(0).margin(1e-8));
    }
    for (const ScoredRowSet& set : result.row_sets) {
        CHECK(set.scores.back().model == "t-rate-drift-axes");
        CHECK(set.scores.back().parameter_count == 6);
        CHECK(set.scores.back().loso_mgal.value() == Approx(0.0).margin(1e-7));
    }
}

TEST_CASE("a model with axes is not chosen automatically, and is refused without their means",
          "[survey][axes_model]") {
    const auto by_itself = correct_survey(tilted_day(), {});
    CHECK(by_itself.model != "t-rate-drift-axes");
    CHECK(by_itself.row_sets[0].scores.size() == 5);  // paper and the four linear models
    auto rows = tilted_day();
    rows[3].record.reset();
    CHECK_THROWS_WITH(
        correct_survey(rows, with_axes()),
        ContainsSubstring("model = t-rate-drift-axes: S3 (1) has no mean_x_g; allowed:"));
    CHECK_THROWS_AS(correct_survey(rows, with_axes()), InputError);
}
