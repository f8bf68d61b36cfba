#include <cmath>
#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/cool_box.hpp"

using namespace a351;
using namespace a351::sim;
using namespace a351::sim::scenario;

namespace {

Scenario box_with(double share) {
    return parse_scenario(
        "base = \"tsukuba\"\nname = \"box\"\n[box]\nseed = 5\nplacement_share = " +
            std::to_string(share),
        "box.toml");
}

}  // namespace

TEST_CASE("the sensors of a box have the same stays, levelling and air", "[sim][box]") {
    const Scenario scenario = box_with(0.0);
    const auto one = plan_survey(scenario, 1), other = plan_survey(scenario, 2);
    REQUIRE(one.size() == other.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        CHECK(one[i].start == other[i].start);
        CHECK(one[i].end == other[i].end);
        CHECK(one[i].about_x_rad == other[i].about_x_rad);
        CHECK(one[i].placement_mgal != other[i].placement_mgal);
    }
    signal::CoolBox of_one(scenario, one, 1), of_other(scenario, other, 2);
    for (int k = 0; k < 1000; ++k) CHECK(of_one.next().value() == of_other.next().value());
}

TEST_CASE("the placement of a box is common to its sensors in the share that is given",
          "[sim][box]") {
    for (const double share : {0.0, 0.5, 1.0}) {
        double products = 0.0, squares = 0.0, count = 0.0;
        for (std::uint64_t seed = 1; seed <= 100; ++seed) {
            Scenario scenario = box_with(share);
            scenario.box->seed = static_cast<int>(seed);
            const auto one = plan_survey(scenario, 1000 + seed),
                       other = plan_survey(scenario, 2000 + seed);
            for (std::size_t i = 0; i < one.size(); ++i) {
                products += one[i].placement_mgal * other[i].placement_mgal;
                squares += std::pow(one[i].placement_mgal, 2);
                count += 1.0;
            }
        }
        // 1900 set-ups: the error of a correlation is 0.023, that of a deviation 2 %.
        CHECK(products / squares == Approx(share).margin(0.1));
        CHECK(std::sqrt(squares / count) == Approx(1.2).epsilon(0.08));
    }
}

TEST_CASE("a box needs a seed and a share", "[sim][box]") {
    CHECK_THROWS_AS(
        parse_scenario("base = \"tsukuba\"\nname = \"box\"\n[box]\nseed = 5\n", "box.toml"),
        InputError);
}
