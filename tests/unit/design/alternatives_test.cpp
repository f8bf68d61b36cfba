#include "corrector/design/alternatives.hpp"

#include "tests/support/temporary_directory.hpp"
#include "tests/unit/design/made_up_plan.hpp"

using namespace a351;
using namespace a351::corrector::design;

namespace {

std::vector<Alternative> found_for(const Plan& plan) {
    const auto sites = made_up_sites();
    return alternatives(plan, sites, usual_unit(),
                        expected_errors(plan, sites, usual_unit()).u_unknown);
}

const Alternative* named(const std::vector<Alternative>& list, const std::string& beginning) {
    const auto found = std::ranges::find_if(
        list, [&](const Alternative& one) { return one.text.starts_with(beginning); });
    return found == list.end() ? nullptr : &*found;
}

}  // namespace

TEST_CASE("each alternative is a plan that has the uncertainty it promises") {
    const auto sites = made_up_sites();
    const Plan plan = made_up_plan("ABCD");
    const MilliGal u = expected_errors(plan, sites, usual_unit()).u_unknown;
    const test::TemporaryDirectory folder;
    const auto list = found_for(plan);
    REQUIRE(list.size() >= 5);
    for (std::size_t i = 0; i < list.size(); ++i) {
        INFO(list[i].text);
        const Plan changed = read_plan(folder.write("plan.csv", plan_csv(list[i].plan)), sites);
        CHECK(changed == list[i].plan);
        CHECK(expected_errors(changed, sites, usual_unit()).u_unknown == list[i].u);
        CHECK(list[i].u.value() <= 0.99 * u.value());
        if (i > 0) CHECK(list[i].u >= list[i - 1].u);
        CHECK(list[i].extra_minutes ==
              Approx(60.0 * (duration_h(changed) - duration_h(plan))).margin(1e-6));
    }
}

TEST_CASE("two set-ups of half the length cost no time and are proposed with their effect") {
    const auto list = found_for(made_up_plan());
    const Alternative* const half = named(list, "two set-ups of half the length at each visit: ");
    REQUIRE(half != nullptr);
    CHECK(half->extra_minutes == 0.0);
    CHECK_THAT(half->text, EndsWith(" mGal, in the same time"));
    CHECK(half->plan == made_up_plan("ABCDA", 2, 6.0));
    CHECK(named(found_for(made_up_plan("ABCDA", 1, 5.0)), "two set-ups of half") == nullptr);
}

TEST_CASE("a visit that is added delays all later ones") {
    const auto list = found_for(made_up_plan("ABCD"));
    const Alternative* const back = named(list, "a return to A at the end: ");
    REQUIRE(back != nullptr);
    CHECK(back->plan == made_up_plan("ABCDA"));  // the drives are equal
    CHECK(back->extra_minutes == Approx(30.0));
    const Alternative* const middle = named(list, "a return to A in the middle, after B: ");
    REQUIRE(middle != nullptr);
    CHECK(middle->plan == made_up_plan("ABACD"));
    const Alternative* const other = named(list, "K, which is known too, after C: ");
    REQUIRE(other != nullptr);
    CHECK(other->plan == made_up_plan("ABCKD"));
}

TEST_CASE("what the plan has already is not proposed") {
    const auto list = found_for(made_up_plan("ABACKDA"));
    CHECK(named(list, "a return to A at the end") == nullptr);
    CHECK(named(list, "K, which is known too") == nullptr);
}

TEST_CASE("turning the box is proposed with its effect") {
    const auto sites = made_up_sites();
    const auto found_with = [&](const Plan& plan, const unit::ScaleShare& share) {
        PlannedUnit unit = usual_unit();
        unit.priors.scale_share = share;
        return alternatives(plan, sites, unit, expected_errors(plan, sites, unit).u_unknown);
    };
    const Plan plan = made_up_plan("ABCDA", 1, 12.0);
    const unit::ScaleShare none{0.0, 0.01, true};
    const auto unknown = found_with(plan, {}), known = found_with(plan, none);
    const std::string turning = "turning the box over between the set-ups";
    REQUIRE(named(unknown, turning) != nullptr);
    REQUIRE(named(known, turning) != nullptr);
    CHECK(named(unknown, turning)->extra_minutes == 0.0);
    CHECK(named(unknown, turning)->plan[0].faces == "+--+");
    CHECK(named(known, turning)->u < named(unknown, turning)->u);
    CHECK(named(found_with(named(unknown, turning)->plan, {}), "the same set-ups in one") ==
          nullptr);
}
