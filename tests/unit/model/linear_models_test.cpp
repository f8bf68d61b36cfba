#include "corrector/model/linear_models.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/model/survey_rows.hpp"

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

}  // namespace

TEST_CASE("a day made of temperature, rate and drift is explained by that model only",
          "[survey][linear_models]") {
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
    "leaving out stations gives larger errors than leaving out rows, which gives larger ones than "
    "the fit",
    "[survey][linear_models]") {
    auto rows = made_up::day();
    for (std::size_t i = 0; i < rows.size(); ++i) {  // an error of the station, the same each time
        rows[i].acceleration = rows[i].acceleration + MilliGal(rows[i].site == "S2" ? 5.0 : 0.0);
    }
    const model::Score score = Survey(rows).score("t-rate-drift");
    CHECK(score.rms_mgal.value() < score.s_mgal.value());
    CHECK(score.s_mgal.value() < score.loo_mgal.value());
    CHECK(score.loo_mgal.value() < score.loso_mgal.value());
}

TEST_CASE("scores that too few rows cannot define are absent", "[survey][linear_models]") {
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

TEST_CASE("rate and drift together are not chosen for few rows with few readings of the base",
          "[survey][linear_models]") {
    auto rows = made_up::day();
    rows.erase(rows.begin() + 4);  // eleven rows, the base twice
    const Survey day(rows);
    CHECK(choose_model(day.problem(), day.in_use).value().model != "t-rate-drift");
}

TEST_CASE("the weight of a prior is its standard deviation relative to that of a reading",
          "[survey][linear_models]") {
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
