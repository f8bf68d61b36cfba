/// The temperature of an outer oven in the whole-day model and in the adjustment of several days.
#include <cmath>
#include "tests/support/catch.hpp"
#include "tests/support/long_tests.hpp"

#include "corrector/whole_day/day_model.hpp"
#include "tests/unit/whole_day/made_up_day.hpp"

using namespace a351;
using namespace a351::corrector::whole_day;
using a351::corrector::reading::DayBin;
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
            auto stations = MadeUpDay::stations();
            for (DayStation& station : stations)
                if (station.number == s) station.gravity.reset();
            const auto fit = fit_day(day, stations);
            squares += std::pow(fit.value().gravity_mgal[s].value - MadeUpDay::gravity_mgal(s), 2);
        }
    }
    return std::sqrt(squares / (2.0 * static_cast<double>(days)));
}

}  // namespace

TEST_CASE("slopes and lag of an outer oven are found", "[day][outer_oven]") {
    const DayRecord day = with_outer_oven(MadeUpDay{}.record(), 4.0, 12.0);
    const auto fit = fit_day(day, MadeUpDay::stations());
    REQUIRE(fit);
    REQUIRE(fit->outer);
    CHECK(fit->outer->mgal_per_degc[0].value == Approx(4.0).margin(0.2));
    CHECK(fit->outer->mgal_per_degc[1].value == Approx(12.0).margin(0.5));
    CHECK(fit->outer->lag_s == Approx(900.0).epsilon(0.05));
    for (const DaySetUp& set_up : fit->set_ups) {
        double effects = 0.0;
        for (const double effect : set_up.effect_mgal) effects += effect;
        CHECK((set_up.reading - set_up.tide - set_up.flicker).value() - effects ==
              Approx(set_up.corrected.value()).epsilon(1e-12));
    }
}

TEST_CASE("a day without an outer oven has no slopes of one", "[day][outer_oven]") {
    const auto fit = fit_day(MadeUpDay{}.record(), MadeUpDay::stations());
    CHECK_FALSE(fit.value().outer);
    CHECK(fit->point.back() == 0.0);
    CHECK(fit->expected.back() == 0.0);
}

TEST_CASE("an outer oven improves days on which it acts, and harms no others",
          "[day][outer_oven]") {
    CHECK(error_with_outer(12.0, true) < 0.8 * error_with_outer(12.0, false));
    CHECK(error_with_outer(0.0, true) < 1.03 * error_with_outer(0.0, false));
}

TEST_CASE("days of one unit share its slopes by the outer oven", "[day][joint][outer_oven]") {
    const MadeUpDay day{.placement_mgal = 1.2, .white_mgal = 0.2};
    std::vector<DayRecord> records;
    for (std::uint64_t seed = 11; seed <= 13; ++seed)
        records.push_back(with_outer_oven(day.record(seed), 4.0, 12.0));
    records[0].outer.reset();  // a day on which it was not recorded
    std::vector<DaySurvey> surveys;
    std::vector<std::size_t> numbers(MadeUpDay::kSites);
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = k;
    for (std::size_t k = 0; k < records.size(); ++k) {
        const auto later = std::chrono::hours(24 * static_cast<int>(k));
        for (DayBin& bin : records[k].bins) {
            bin.time += later;
            for (UtcTime& time : bin.times) time += later;
        }
        auto& degc = records[k].temperature.series;
        degc = TimeSeries<DegC>(degc.start() + later, degc.rate(), degc.values());
        auto& outer = records[k].outer;
        if (outer) outer = TimeSeries<DegC>(degc.start(), degc.rate(), outer->values());
        surveys.push_back(
            {&records[k], MadeUpDay::stations(), usual_day_priors(), numbers, std::size_t{0}});
    }
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
