#include "corrector/design/expected_errors.hpp"

#include <cmath>

#include "corrector/design/planned_day.hpp"
#include "corrector/whole_day/day_model.hpp"
#include "tests/unit/design/made_up_plan.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::design;

TEST_CASE("placement alone adds the variances of both stations' means") {
    // u^2 = placement^2 (1 / set-ups of the station + 1 / set-ups of the only datum)
    const PlannedUnit unit = known_unit({1.5, 1e-6, 1e-3});
    for (const int set_ups : {1, 2, 5}) {
        const ExpectedErrors errors =
            expected_errors(made_up_plan("ABCDCA", set_ups, 6.0), made_up_sites(), unit);
        CHECK(u_of(errors, "A") == MilliGal(0.0));
        const double of_one = 1.5 * 1.5 / set_ups;
        CHECK(u_of(errors, "B").value() == Approx(std::sqrt(of_one * 1.5)).epsilon(1e-3));
        CHECK(u_of(errors, "C").value() == Approx(std::sqrt(of_one)).epsilon(1e-3));
        CHECK(errors.u_unknown.value() ==
              Approx(std::sqrt(of_one * (1.5 + 1.0 + 1.5) / 3.0)).epsilon(1e-3));
        // B and D do not need the datum.
        CHECK(errors.differences.size() == 6);
        CHECK(errors.differences[4].from == "B");
        CHECK(errors.differences[4].to == "D");
        CHECK(errors.differences[4].u.value() == Approx(std::sqrt(2.0 * of_one)).epsilon(1e-3));
    }
}

TEST_CASE("an uncertain reference adds its variance to every unknown station") {
    const PlannedUnit unit = known_unit({1.0, 1e-6, 1e-3});
    auto sites = made_up_sites();
    const MilliGal before = u_of(expected_errors(made_up_plan(), sites, unit), "C");
    sites[0].u_gravity = MilliGal(2.0);
    const ExpectedErrors errors = expected_errors(made_up_plan(), sites, unit);
    CHECK(u_of(errors, "A").value() == Approx(2.0).epsilon(1e-3));
    CHECK(u_of(errors, "C").value() == Approx(std::hypot(2.0, before.value())).epsilon(1e-3));
}

TEST_CASE("noise twice as large makes uncertainties twice as large, at any length") {
    const auto sites = made_up_sites();
    for (const double minutes : {3.0, 12.0}) {
        const Plan plan = made_up_plan("ABCDA", 1, minutes);
        const MilliGal once = expected_errors(plan, sites, known_unit({1.2, 1.2, 0.3})).u_unknown;
        const MilliGal twice = expected_errors(plan, sites, known_unit({2.4, 2.4, 0.6})).u_unknown;
        CHECK(twice.value() == Approx(2.0 * once.value()).epsilon(1e-6));
    }
}

TEST_CASE("the sources of a station's uncertainty add up to it") {
    const ExpectedErrors errors = expected_errors(made_up_plan(), made_up_sites(), usual_unit());
    for (const ExpectedStation& station : errors.stations) {
        double sum = 0.0;
        for (const double part : station.parts_mgal) sum += part * part;
        CHECK(std::sqrt(sum) == Approx(station.u.value()).margin(1e-9));
        CHECK(station.is_known == (station.site == "A"));
    }
}

TEST_CASE("eight times as many courses of the temperature give the same uncertainty") {
    const auto sites = made_up_sites();
    const PlannedUnit unit = usual_unit();
    const Plan plan = made_up_plan("ABCDA", 1, 12.0);
    double sum = 0.0, count = 0.0;
    constexpr std::size_t kMany = 128;
    for (std::size_t course = 0; course < kMany; ++course) {
        PlannedDay day = planned_day(plan, sites, unit, course);
        const auto adjusted = whole_day::adjust_planned_day(
                                  day.record, {nullptr, day.stations, unit.priors}, unit.noise)
                                  .value();
        for (std::size_t number = 0; number < day.sites.size(); ++number) {
            const auto gravity = adjusted.gravity(number);
            if (gravity.standard_error == 0.0) continue;
            sum += gravity.standard_error * gravity.standard_error;
            count += 1.0;
        }
    }
    const double many = std::sqrt(sum / count);
    const double few = expected_errors(plan, sites, unit).u_unknown.value();
    INFO(few << " mGal over " << kCourses << " courses, " << many << " mGal over " << kMany);
    CHECK(few == Approx(many).epsilon(0.03));
}

TEST_CASE("more readings never make a plan worse") {
    const auto sites = made_up_sites();
    const PlannedUnit unit = usual_unit();
    const auto u = [&](const Plan& plan) {
        return expected_errors(plan, sites, unit, Detail::stations).u_unknown.value();
    };
    const double plan = u(made_up_plan());
    CHECK(u(made_up_plan("ABCDA", 2, 6.0)) < plan);
    CHECK(u(made_up_plan("ABCDA", 2, 12.0)) < u(made_up_plan("ABCDA", 2, 6.0)));
    CHECK(u(made_up_plan("ABCDA", 1, 20.0)) < plan);
    CHECK(u(made_up_plan("ABCDAK")) < plan);
    CHECK(u(made_up_plan("ABCDKA")) < plan);
}
