/// The temperature of an outer oven in the whole-day model and in the adjustment of several days.
#include "tests/support/long_tests.hpp"

#include "tests/unit/whole_day/made_up_day.hpp"

using namespace a351;
using namespace a351::corrector::whole_day;
using a351::corrector::reading::DayRecord;

namespace {

/// Returns the rms error of stations 3 and 9 if they are unknown, over days.
double error_with_outer(double slope, bool is_seen) {
    const std::uint64_t days = test::is_long() ? 10 : 3;
    double squares = 0.0;
    for (std::uint64_t seed = 1; seed <= days; ++seed) {
        DayRecord day = with_outer_oven(MadeUpDay{.placement_mgal = 1.2}.record(seed), 0.0, slope);
        if (!is_seen) day.outer.reset();
        for (const std::size_t s : {3U, 9U}) {
            const auto fit = fit_day(day, stations_without({s}));
            squares += std::pow(fit.value().gravity_mgal[s].value - MadeUpDay::gravity_mgal(s), 2);
        }
    }
    return std::sqrt(squares / (2.0 * static_cast<double>(days)));
}

}  // namespace

TEST_CASE("slopes and lag of an outer oven are found") {
    const DayRecord day = with_outer_oven(MadeUpDay{}.record(), 4.0, 12.0);
    const auto fit = fit_day(day, MadeUpDay::stations());
    REQUIRE(fit);
    REQUIRE(fit->outer);
    CHECK(fit->outer->mgal_per_degc[0].value == Approx(4.0).margin(0.2));
    CHECK(fit->outer->mgal_per_degc[1].value == Approx(12.0).margin(0.5));
    CHECK(fit->outer->lag_s == Approx(900.0).epsilon(0.05));
    for (const DaySetUp& set_up : fit->set_ups)
        CHECK(corrected_mgal(set_up) == Approx(set_up.corrected.value()).epsilon(1e-12));
}

TEST_CASE("a day without an outer oven has no slopes of one") {
    const auto fit = fit_day(MadeUpDay{}.record(), MadeUpDay::stations());
    CHECK_FALSE(fit.value().outer);
    CHECK(fit->point.back() == 0.0);
    CHECK(fit->expected.back() == 0.0);
}

TEST_CASE("an outer oven improves days on which it acts, and harms no others") {
    CHECK(error_with_outer(12.0, true) < 0.8 * error_with_outer(12.0, false));
    CHECK(error_with_outer(0.0, true) < 1.03 * error_with_outer(0.0, false));
}

TEST_CASE("days of one unit share its slopes by the outer oven") {
    std::vector<DayRecord> records;
    for (int k = 0; k < 3; ++k)
        records.push_back(
            later(with_outer_oven(kScattered.record(static_cast<std::uint64_t>(11 + k)), 4.0, 12.0),
                  k * kOneDay));
    records[0].outer.reset();  // a day on which it was not recorded
    std::vector<DaySurvey> surveys;
    for (const DayRecord& record : records)
        surveys.push_back(survey_of(record, 0, MadeUpDay::stations()));
    const DayAdjustment joint = adjust_days(surveys);
    const Estimate alone =
        fit_day(records[1], MadeUpDay::stations()).value().outer.value().mgal_per_degc[1];
    const DayFit last = joint.fit(2);
    CHECK_FALSE(joint.fit(0).outer);  // its day has no column for it
    for (const std::size_t k : {1U, 2U}) {
        const DayFit survey = joint.fit(k);
        REQUIRE(survey.outer);
        const Estimate& slow = survey.outer->mgal_per_degc[1];
        CHECK(slow.value == last.outer->mgal_per_degc[1].value);
        CHECK(slow.standard_error < 0.85 * alone.standard_error);
        CHECK(std::abs(slow.value - 12.0) < 3.0 * slow.standard_error);
    }
}
