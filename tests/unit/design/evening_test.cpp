#include "corrector/design/evening.hpp"

#include "tests/unit/design/made_up_plan.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::design;

namespace {

const whole_day::DayNoise kNoise{1.2, 1.2, 0.25};

/// Returns the correction of a day of visits so far; the key of a stay is its place, "0", "1" and so on.
model::SurveyCorrection corrected(const Plan& plan, double u_mgal) {
    model::SurveyCorrection result;
    result.own = model::WholeDayPart{};
    std::get<model::WholeDayPart>(result.own).unit.noise = kNoise;
    for (std::size_t i = 0; i < plan.size(); ++i) {
        const Visit& visit = plan[i];
        const text::Site site = *text::find_site(made_up_sites(), visit.site);
        for (int k = 0; k < visit.set_ups; ++k) {
            model::CorrectedRow& row = result.rows.emplace_back();
            row.row.site = visit.site;
            row.row.key = std::to_string(i);
            row.row.reference = site.gravity;
            row.row.start = visit.start + from_seconds(60.0 * k * visit.minutes_each);
            row.row.end = *row.row.start + from_seconds(60.0 * visit.minutes_each);
        }
        model::StationValue& station = result.stations.emplace_back();
        station.site = visit.site;
        station.u_gravity = MilliGal(u_mgal);
    }
    return result;
}

}  // namespace

TEST_CASE("the uncertainty in the evening is that of the visits so far and a return to the base") {
    for (const int set_ups : {1, 2}) {
        const double each_min = 12.0 / set_ups;
        const Plan so_far = made_up_plan("AB", set_ups, each_min);
        const Plan with_return = made_up_plan("ABA", set_ups, each_min);
        PlannedUnit unit = usual_unit();
        unit.noise = kNoise;
        const auto expected_mgal = [&](const Plan& plan) {
            return u_of(expected_errors(plan, made_up_sites(), unit), "B").value();
        };
        const double ratio = expected_mgal(with_return) / expected_mgal(so_far);
        CHECK(ratio < 0.9);
        const auto u = u_in_the_evening(corrected(so_far, 3.0), made_up_sites(), "1");
        REQUIRE(u);
        CHECK(u->value() == Approx(3.0 * ratio).epsilon(1e-9));
    }
}

TEST_CASE("there is no uncertainty in the evening without a running stay at an unknown station") {
    auto day = corrected(made_up_plan("ABA"), 3.0);
    CHECK(!u_in_the_evening(day, made_up_sites(), "2"));     // known
    CHECK(!u_in_the_evening(day, made_up_sites(), "1"));     // not the last
    CHECK(!u_in_the_evening(day, made_up_sites(), ""));      // none runs
    CHECK(!u_in_the_evening(day, made_up_sites(), "other"));  // no reading yet
    day = corrected(made_up_plan("AB"), 3.0);
    CHECK(!u_in_the_evening(day, {}, "1"));
    CHECK(!u_in_the_evening(corrected(made_up_plan("AB", 1, 1.5), 3.0), made_up_sites(), "1"));
    day.own = model::NetworkPart{};
    CHECK(!u_in_the_evening(day, made_up_sites(), "1"));
}
