#include "corrector/model/linear_models.hpp"

#include "protocol/core/input_error.hpp"
#include "tests/unit/model/corrections.hpp"

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::model;

namespace {

/// A survey whose rows are all in use, with B as base.
struct Survey {
    std::vector<reading::SurveyRow> rows;
    SurveyOptions options;
    std::vector<bool> in_use;

    explicit Survey(std::vector<reading::SurveyRow> of)
        : rows(std::move(of)), in_use(rows.size(), true) {
        options.base = "B";
    }
    [[nodiscard]] SurveyProblem problem() const { return {rows, options, nullptr}; }
    [[nodiscard]] Score score(const std::string& model) const {
        return score_linear_model(*find_linear_model(model), problem(), in_use);
    }
};

constexpr double kX_mgal_per_g = 1500.0;
constexpr double kY_mgal_per_g = -800.0;

/// Returns the made-up day with a different tilt of the box in each row.
std::vector<reading::SurveyRow> tilted_day() {
    auto rows = made_up::day();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double x_g = 0.002 * std::sin(2.3 * static_cast<double>(i));
        const double y_g = 0.002 * std::cos(3.1 * static_cast<double>(i));
        reading::RecordSummary& record = rows[i].record.emplace();
        record.x.mean = StandardGravity(x_g);
        record.y.mean = StandardGravity(y_g);
        add(rows[i], kX_mgal_per_g * x_g + kY_mgal_per_g * y_g);
    }
    return rows;
}

}  // namespace

TEST_CASE("a day made of temperature, rate and drift is explained by that model only") {
    const Survey day(made_up::day());
    for (const LinearModel& model : compared_models()) {
        CAPTURE(model.name);
        const model::Score score = day.score(std::string(model.name));
        const bool is_complete = model.name == "t-rate-drift";
        CHECK((score.rms_mgal.value() < 1e-6) == is_complete);
        CHECK((score.loso_mgal.value() < 1e-6) == is_complete);
    }
    CHECK(choose_model(day.problem(), day.in_use).value().model == "t-rate-drift");
    // Without the base fewer than twelve rows are left, so that this fold must use a smaller model.
    const double choosing = choice_loso_mgal(day.problem(), day.in_use).value();
    CHECK(choosing > 0.01);
    CHECK(choosing < 1.0);
}

TEST_CASE(
    "leaving out stations gives larger errors than leaving out rows, which gives larger ones "
    "than the fit") {
    auto rows = made_up::day();
    for (reading::SurveyRow& row : rows)  // an error of the station, the same each time
        add(row, row.site == "S2" ? 5.0 : 0.0);
    const model::Score score = Survey(rows).score("t-rate-drift");
    CHECK(score.rms_mgal.value() < score.s_mgal.value());
    CHECK(score.s_mgal.value() < score.loo_mgal.value());
    CHECK(score.loo_mgal.value() < score.loso_mgal.value());
}

TEST_CASE("scores that too few rows cannot define are absent") {
    auto rows = made_up::day();
    rows.resize(3);
    const model::Score line = Survey(rows).score("t");
    CHECK(line.rms_mgal.has_value());
    CHECK(line.s_mgal.has_value());
    CHECK_FALSE(line.aicc.has_value());
    const model::Score full = Survey(rows).score("t-rate-drift");
    CHECK_FALSE(full.rms_mgal.has_value());
    CHECK_FALSE(full.loso_mgal.has_value());
}

TEST_CASE("rate and drift together are not chosen for few rows with few readings of the base") {
    auto rows = made_up::day();
    rows.erase(rows.begin() + 4);  // eleven rows, the base twice
    const Survey day(rows);
    CHECK(choose_model(day.problem(), day.in_use).value().model != "t-rate-drift");
}

TEST_CASE("the weight of a prior is its standard deviation relative to that of a reading") {
    const auto rate = [&](double sd, double reading_sd_mgal) {
        Survey day(made_up::day());
        day.options.priors.reading_sd_mgal = reading_sd_mgal;
        set_prior(day.options.priors, "test", "rate_mgal_per_degc_per_h", {0.0, sd});
        return adjust_linear(*find_linear_model("t-rate-drift"), day.problem(), day.in_use)
            .coefficient(2);
    };
    CHECK(rate(6.0, 2.0) == Approx(rate(12.0, 4.0)));
    CHECK(rate(6.0, 2.0) > rate(6.0, 4.0) + 0.1);
    CHECK(rate(6.0, 4.0) > 0.1);
}

TEST_CASE("the fit finds the biases of the horizontal axes with temperature, rate and drift") {
    const auto result = correct_survey(tilted_day(), by_model("t-rate-drift-axes"));
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
        CHECK(row.tilt_correction);
        CHECK(sum_mgal(row) == Approx(row.corrected.value()).epsilon(0).margin(1e-8));
    }
    for (const ScoredRowSet& set : result.row_sets) {
        CHECK(set.scores.back().model == "t-rate-drift-axes");
        CHECK(set.scores.back().parameter_count == 6);
        CHECK(set.scores.back().loso_mgal.value() == Approx(0.0).margin(1e-7));
    }
}

TEST_CASE("a model with axes is not chosen automatically, and is refused without their means") {
    const auto by_itself = correct_survey(tilted_day(), {});
    CHECK(by_itself.model != "t-rate-drift-axes");
    CHECK(by_itself.row_sets[0].scores.size() == 5);  // paper and the four linear models
    auto rows = tilted_day();
    rows[3].record.reset();
    CHECK_THROWS_WITH(
        correct_survey(rows, by_model("t-rate-drift-axes")),
        ContainsSubstring("model = t-rate-drift-axes: S3 (1) has no mean_x_g; allowed:"));
    CHECK_THROWS_AS(correct_survey(rows, by_model("t-rate-drift-axes")), InputError);
}
