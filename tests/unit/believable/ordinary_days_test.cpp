#include "tests/support/catch.hpp"
#include "tests/support/wrong_sensor.hpp"

namespace a351::sim {
namespace {

using scenario::load_scenario;

std::string found(const WatchedRecord& record) {
    const auto troubles = first_troubles(record);
    return troubles ? troubles->texts.front() : "";
}

TEST_CASE(
    "a survey day, an oven in a hot car, a start in the cold and a turned box are no trouble") {
    CHECK(found({load_scenario("tsukuba"), 11}) == "");
    CHECK(found({load_scenario("roadside"), 12, 4 * kSecondsPerHour}) == "");
    scenario::Scenario hot = load_scenario("hot-afternoon");
    for (auto& ambient : hot.ambient) ambient.degc += 25.0;
    CHECK(found({hot, 13}) == "");
    scenario::Scenario cold = load_scenario("warm-up");
    const DegC set_point(cold.oven.set_point_degc);
    cold.oven.set_point_degc = -10.0;
    CHECK(found({cold, 14, 4 * kSecondsPerHour, set_point}) == "");
    CHECK(found({load_scenario("tumble"), 15}) == "");
}

TEST_CASE("every kind of wrong sensor is named within its time, in the middle of a stay") {
    for (const WrongSensor& wrong : wrong_sensors()) {
        if (wrong.within_s > 1000.0) continue;  // The bench has a day for it.
        INFO(wrong.name);
        const double history_s = wrong.is_at_next_start ? 300.5 : 0.0;
        const auto troubles = first_troubles(
            {load_scenario("indoor"), 16, 1800.0, std::nullopt, &wrong, 300.5, history_s});
        REQUIRE(troubles);
        CHECK(troubles->at_s <= wrong.within_s);
        REQUIRE(troubles->texts.size() == 1);
        CHECK(troubles->texts.front().find(wrong.words) != std::string::npos);
        if (!wrong.is_at_next_start)
            CHECK(troubles->texts.front().find("a351d --config FILE --identify") !=
                  std::string::npos);
    }
}

}  // namespace
}  // namespace a351::sim
