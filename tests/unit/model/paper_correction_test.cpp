#include "corrector/model/paper_correction.hpp"

#include "tests/unit/model/survey_rows.hpp"

using namespace a351;
using namespace a351::corrector::model;
using namespace a351::corrector::reading;

namespace {

const std::vector<bool> kAll(12, true);

std::vector<double> corrected1(const std::vector<SurveyRow>& rows) {
    return temperature_corrected_mgal(rows, fit_temperature_line(rows, kAll).value());
}

}  // namespace

TEST_CASE("after the drift step the first and last base readings equal the reference") {
    const auto rows = made_up::day();
    const auto first = corrected1(rows);
    const auto step = find_end_point_drift(rows, kAll, first, "B");
    const auto errors = errors_mgal(rows, drift_corrected_mgal(rows, first, step.drift.value()));
    CHECK(std::abs(errors.front()) < 1e-9);
    CHECK(std::abs(errors.back()) < 1e-9);
}

TEST_CASE("errors of the temperature line average to zero over the rows of the fit") {
    const auto rows = made_up::day();
    double sum = 0.0;
    for (const double error : errors_mgal(rows, corrected1(rows))) sum += error;
    CHECK(std::abs(sum) < 1e-7);
}

TEST_CASE("the drift step is refused with one occupation of the base") {
    const auto rows = made_up::day();
    const auto step = find_end_point_drift(rows, kAll, corrected1(rows), "S1");
    CHECK_FALSE(step.drift.has_value());
    CHECK(step.refusal == "base S1 has fewer than two occupations, two are needed");
}

TEST_CASE("two set-ups of one stay do not count as two occupations of the base") {
    auto rows = made_up::day();
    for (SurveyRow& row : rows) {
        if (row.site == "S2") row.occupation = 1;
    }
    CHECK_FALSE(find_end_point_drift(rows, kAll, corrected1(rows), "S2").drift.has_value());
}

TEST_CASE("the drift step is refused if the first and last base readings are flagged") {
    const auto rows = made_up::day();
    auto in_use = kAll;
    in_use.front() = false;
    CHECK(find_end_point_drift(rows, in_use, corrected1(rows), "B").drift.has_value());
    in_use.back() = false;
    const auto step = find_end_point_drift(rows, in_use, corrected1(rows), "B");
    CHECK_FALSE(step.drift.has_value());
    CHECK(step.refusal == "base B is not in use in its first and last occupation");
}

TEST_CASE("a station without a reference is corrected and has no error") {
    auto rows = made_up::day();
    const auto known = corrected1(rows);
    auto in_use = kAll;
    in_use[1] = false;
    const auto line = fit_temperature_line(rows, in_use).value();
    const double expected = temperature_corrected_mgal(rows, line)[1];
    rows[1].reference.reset();
    CHECK(fit_temperature_line(rows, kAll).value().slope == line.slope);
    CHECK(temperature_corrected_mgal(rows, line)[1] == expected);
    CHECK(std::isnan(errors_mgal(rows, known)[1]));
    CHECK(std::isnan(differences_mgal(rows)[1]));
}
