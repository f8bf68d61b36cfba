#include "tests/unit/model/corrections.hpp"
#include "tests/unit/model/rows_of_day.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector;

namespace {

constexpr double kStep_mgal = 30.0;

SurveyOptions options_of(const std::string& model, const std::vector<UtcTime>& steps) {
    SurveyOptions options = by_model(model);
    for (const UtcTime step : steps) options.steps.push_back({step});
    return options;
}

double largest_residual_mgal(const SurveyCorrection& result) {
    double largest = 0.0;
    for (const CorrectedRow& row : result.rows) {
        if (row.residual) largest = std::max(largest, std::abs(row.residual->value()));
        CHECK(std::abs(sum_mgal(row) - row.corrected.value()) < 1e-8);
    }
    return largest;
}

}  // namespace

TEST_CASE("linear models and the network estimate a step of the readings") {
    std::vector<reading::SurveyRow> rows = made_up::day();
    for (std::size_t i = 5; i < rows.size(); ++i) add(rows[i], kStep_mgal);
    const UtcTime step = rows[4].time + (rows[5].time - rows[4].time) / 2;
    const auto result = correct_survey(rows, options_of("t-rate-drift", {step}));
    CHECK(std::abs(coefficient(result, "step_1_mgal").value - kStep_mgal) < 1e-6);
    CHECK(largest_residual_mgal(result) < 1e-6);
    CHECK(largest_residual_mgal(correct_survey(rows, options_of("t-rate-drift", {}))) > 3.0);
    // The network has no rate, which leaves a few mGal.
    const auto network = correct_survey(rows, options_of("network", {step}));
    CHECK(std::abs(coefficient(network, "step_1_mgal").value - kStep_mgal) < 5.0);
}

TEST_CASE("the network has no unknown for a step that it cannot see") {
    const std::vector<reading::SurveyRow> rows = made_up::day();
    const UtcTime before = rows.front().time - std::chrono::minutes(5),
                  after = rows.back().time + std::chrono::minutes(5);
    const auto result = correct_survey(rows, options_of("network", {before, after}));
    for (const Coefficient& one : result.coefficients) CHECK_FALSE(one.name.starts_with("step"));
}

TEST_CASE("a linear model refuses a step without a reading after it") {
    const std::vector<reading::SurveyRow> rows = made_up::day();
    CHECK_THROWS_WITH(
        correct_survey(rows, options_of("t-drift", {rows.back().time + std::chrono::minutes(5)})),
        ContainsSubstring("some after each step"));
}

TEST_CASE("the whole-day model estimates a step, and unknown stations after it") {
    reading::DayRecord day = whole_day::MadeUpDay{}.record();
    std::vector<reading::SurveyRow> rows = rows_of(day);
    for (auto& bin : day.bins)
        if (bin.set_up >= 6) bin.reading = bin.reading + MilliGal(kStep_mgal);
    rows[8].reference.reset();  // S8 is visited once
    const double true_mgal = whole_day::MadeUpDay::gravity_mgal(8);
    const UtcTime step = rows[5].time + (rows[6].time - rows[5].time) / 2;
    const auto result = correct_survey(rows, options_of("day", {step}), &day);
    CHECK(std::abs(coefficient(result, "step_1_mgal").value - kStep_mgal) < 0.05);
    CHECK(std::abs(result.rows[8].corrected.value() - true_mgal) < 0.05);
    const auto without = correct_survey(rows, options_of("day", {}), &day);
    CHECK(std::abs(without.rows[8].corrected.value() - true_mgal) > 1.0);
}
