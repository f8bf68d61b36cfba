#include "corrector/whole_day/day_model.hpp"

#include "tests/unit/whole_day/made_up_day.hpp"

using namespace a351;
using namespace a351::corrector::whole_day;
using a351::corrector::reading::DayRecord;

namespace {

constexpr std::array<std::size_t, 3> kUnknown{3, 5, 9};

/// Returns the stations of the made-up day with three of them unknown.
std::vector<DayStation> some_known() { return stations_without({3, 5, 9}); }

DaySurvey survey_of(const DayRecord& record, std::size_t unit) {
    return corrector::whole_day::survey_of(record, unit, some_known());
}

}  // namespace

TEST_CASE("a day in one face and one in two have the same slopes") {
    // Half of the response acts on the scale, which the day in one face cannot see.
    MadeUpDay two{.has_two_faces = true, .scale_share = 0.5}, one = two;
    one.has_two_faces = false;
    const DayRecord a = two.record(11), b = later(one.record(12), kOneDay);
    const DayAdjustment joint = adjust_days({survey_of(a, 0), survey_of(b, 0)});
    for (const std::size_t survey : {0U, 1U})
        CHECK(coefficient(joint.fit(survey), DayTerm::level).value ==
              Approx(two.level).margin(0.1));
    CHECK(joint.fit(0).on_scale.at(0).value == Approx(0.5 * two.level).margin(0.1));
    CHECK(joint.fit(1).on_scale.empty());
    for (const std::size_t number : kUnknown)
        CHECK(joint.gravity(number).value == Approx(MadeUpDay::gravity_mgal(number)).margin(0.01));
}

TEST_CASE("days of one unit share its response, and have their own constants") {
    MadeUpDay second = kScattered;
    second.constant += 400.0;
    second.drift = -0.7;
    const DayRecord a = kScattered.record(11), b = later(second.record(12), kOneDay);
    const DayAdjustment joint = adjust_days({survey_of(a, 0), survey_of(b, 0)});
    const FittedDay alone = fit_day(a, some_known()).value(),
                    other = fit_day(b, some_known()).value();
    CHECK(coefficient(joint.fit(0), DayTerm::level).value ==
          Approx(coefficient(joint.fit(1), DayTerm::level).value));
    CHECK(coefficient(joint.fit(0), DayTerm::level).standard_error <
          0.85 * coefficient(alone, DayTerm::level).standard_error);
    CHECK(coefficient(joint.fit(1), DayTerm::constant).value -
              coefficient(joint.fit(0), DayTerm::constant).value ==
          Approx(400.0).margin(6.0));
    for (const std::size_t number : kUnknown) {
        const Estimate gravity = joint.gravity(number);
        CHECK(gravity.standard_error < alone.gravity_mgal[number].standard_error);
        CHECK(gravity.standard_error < other.gravity_mgal[number].standard_error);
        CHECK(std::abs(gravity.value - MadeUpDay::gravity_mgal(number)) <
              3.0 * gravity.standard_error);
    }
    CHECK_FALSE(joint.share());
}

TEST_CASE("units with only stations in common give the weighted mean of their days") {
    const DayRecord a = kScattered.record(21), b = later(kScattered.record(22), kOneDay);
    const DayAdjustment joint = adjust_days({survey_of(a, 0), survey_of(b, 1)});
    const FittedDay of_a = fit_day(a, some_known()).value(),
                    of_b = fit_day(b, some_known()).value();
    for (const std::size_t number : kUnknown) {
        const double u_a = of_a.gravity_mgal[number].standard_error,
                     u_b = of_b.gravity_mgal[number].standard_error;
        const double weight = 1.0 / (u_a * u_a), other = 1.0 / (u_b * u_b);
        CHECK(joint.gravity(number).value == Approx((weight * of_a.gravity_mgal[number].value +
                                                     other * of_b.gravity_mgal[number].value) /
                                                    (weight + other))
                                                 .margin(0.25));
        CHECK(joint.gravity(number).standard_error ==
              Approx(1.0 / std::sqrt(weight + other)).epsilon(0.15));
    }
}

TEST_CASE("the share of the placement that a box has is found") {
    double last_u_mgal = 0.0;
    for (const double share : {0.0, 1.0}) {
        const std::vector<DayRecord> records = box_of(3, share, 8);
        std::vector<DaySurvey> surveys;
        for (std::size_t k = 0; k < records.size(); ++k)
            surveys.push_back(survey_of(records[k], k));
        const DayAdjustment joint = adjust_days(surveys);
        REQUIRE(joint.share());
        CHECK(joint.share()->lowest <= share);
        CHECK(joint.share()->highest >= share);
        CHECK(std::abs(joint.share()->expected - share) < 0.4);
        CHECK(joint.fit().noise.placement_mgal == Approx(1.2).epsilon(0.4));
        // More sensors do not reduce their common error.
        const double u_mgal = joint.gravity(9).standard_error;
        CHECK(u_mgal > last_u_mgal);
        last_u_mgal = u_mgal;
    }
}

TEST_CASE("the order of surveys has no effect on the gravities") {
    const std::vector<DayRecord> records = box_of(2, 0.5, 9);
    const DayRecord next = later(kScattered.record(31), kOneDay);
    const DayAdjustment one =
        adjust_days({survey_of(records[0], 0), survey_of(records[1], 1), survey_of(next, 0)});
    const DayAdjustment other =
        adjust_days({survey_of(next, 1), survey_of(records[1], 0), survey_of(records[0], 1)});
    REQUIRE(one.share());
    CHECK(other.share()->expected == Approx(one.share()->expected).margin(0.02));
    for (const std::size_t number : kUnknown)
        CHECK(other.gravity(number).value == Approx(one.gravity(number).value).margin(0.02));
}
