#include "sim/scenario/scenario.hpp"

#include <catch2/catch.hpp>

#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"
#include "sim/scenario/embedded_scenarios.hpp"
#include "sim/scenario/survey_plan.hpp"

using namespace a351;
using namespace a351::sim;
using Catch::Matchers::Contains;

namespace {

std::string tsukuba_toml() {
    for (const EmbeddedScenario& scenario : embedded_scenarios()) {
        if (scenario.name == "tsukuba") return std::string(scenario.toml);
    }
    return "";
}

std::string with(std::string text, const std::string& old_text, const std::string& new_text) {
    const std::size_t at = text.find(old_text);
    REQUIRE(at != std::string::npos);
    return text.replace(at, old_text.size(), new_text);
}

}  // namespace

TEST_CASE("every named scenario loads under its own name", "[sim][scenario]") {
    CHECK(scenario_names().size() >= 3);
    for (const std::string_view name : scenario_names()) {
        CHECK(load_scenario(std::string(name)).name == name);
    }
}

TEST_CASE("a scenario overrides only what it names of its base", "[sim][scenario]") {
    const Scenario base = load_scenario("tsukuba");
    const Scenario tilted = load_scenario("tilted");
    CHECK(base.sensor.horizontal_bias_max_mgal == 0.0);
    CHECK(tilted.sensor.horizontal_bias_max_mgal == 2000.0);
    CHECK(tilted.sensor.levelling_sigma_deg == base.sensor.levelling_sigma_deg);
    CHECK(tilted.occupations.size() == base.occupations.size());
    CHECK(tilted.oven.heater_capacity_j_per_k == base.oven.heater_capacity_j_per_k);
}

TEST_CASE("unknown and missing keys and impossible values are refused by name", "[sim][scenario]") {
    const std::string good = tsukuba_toml();
    CHECK_NOTHROW(parse_scenario(good, "day.toml"));
    CHECK_THROWS_WITH(
        parse_scenario(with(good, "white_mgal = 2.5", "white_mgals = 2.5"), "day.toml"),
        Contains("day.toml:") && Contains("sensor.white_mgal") && Contains("missing"));
    CHECK_THROWS_WITH(
        parse_scenario(with(good, "[sensor]\n", "[sensor]\nextra_mgal = 1.0\n"), "day.toml"),
        Contains("extra_mgal"));
    CHECK_THROWS_WITH(
        parse_scenario(with(good, "crystal_tau_s = 43.0", "crystal_tau_s = -43.0"), "day.toml"),
        Contains("crystal_tau_s") && Contains("-43"));
    CHECK_THROWS_WITH(
        parse_scenario(with(good, "vehicle_s = [5.0, 20.0]", "vehicle_s = [20.0, 5.0]"),
                       "day.toml"),
        Contains("vehicle_s"));
    CHECK_THROWS_WITH(parse_scenario("base = \"nowhere\"\nname = \"x\"\n", "day.toml"),
                      Contains("nowhere") && Contains("tsukuba"));
    CHECK_THROWS_AS(load_scenario("no-such-scenario"), InputError);
}

TEST_CASE("sites and occupations are those of the published tables", "[sim][scenario]") {
    const Scenario scenario = load_scenario("tsukuba");
    const auto sites = text::read_sites(A351_GOLDEN "/tsukuba/sites.csv");
    REQUIRE(scenario.sites.size() == sites.size());
    for (std::size_t i = 0; i < sites.size(); ++i) {
        CHECK(scenario.sites[i].name == sites[i].name);
        CHECK(scenario.sites[i].longitude == sites[i].longitude);
        CHECK(scenario.sites[i].latitude == sites[i].latitude);
        CHECK(scenario.sites[i].altitude == sites[i].altitude);
        CHECK(scenario.sites[i].gravity == sites[i].gravity);
    }
    const text::CsvTable rows = text::read_csv(A351_GOLDEN "/tsukuba/observations.csv");
    REQUIRE(scenario.occupations.size() == rows.row_count());
    for (std::size_t row = 0; row < rows.row_count(); ++row) {
        const ListedOccupation& occupation = scenario.occupations[row];
        CHECK(occupation.site == rows.cell(row, "site"));
        CHECK(occupation.number == rows.number(row, "occupation"));
        CHECK(occupation.centre == *parse_rfc3339(rows.cell(row, "time_jst") + "+09:00"));
        CHECK(occupation.is_outlier == (rows.number(row, "outlier") == 1.0));
    }
}

TEST_CASE("ambient is linear between the occupations and constant outside", "[sim][scenario]") {
    const Scenario scenario = load_scenario("tsukuba");
    const auto& first = scenario.occupations[0];
    const auto& second = scenario.occupations[1];
    CHECK(scenario.ambient(first.centre).value() == Approx(24.3));
    CHECK(scenario.ambient(first.centre + (second.centre - first.centre) / 2).value() ==
          Approx(0.5 * (24.3 + 23.4)));
    CHECK(scenario.ambient(scenario.start() - std::chrono::hours(5)).value() == Approx(24.3));
    CHECK(scenario.ambient(scenario.end() + std::chrono::hours(5)).value() == Approx(29.2));
}

TEST_CASE("occupations keep order, length and distance for any seed", "[sim][survey_plan]") {
    const Scenario scenario = load_scenario("tsukuba");
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const auto plan = plan_survey(scenario, seed);
        REQUIRE(plan.size() == scenario.occupations.size());
        for (std::size_t i = 0; i < plan.size(); ++i) {
            const double length_s = seconds_between(plan[i].start, plan[i].end);
            REQUIRE(length_s >= 540.0 - 0.002);
            REQUIRE(length_s <= 840.0 + 0.002);
            REQUIRE(plan[i].end < scenario.end());
            if (i > 0) {
                REQUIRE(plan[i - 1].end < plan[i].arrival);
                REQUIRE(plan[i].arrival < plan[i].start);
            }
        }
    }
}

TEST_CASE("occupations close together are moved apart, not overlapped", "[sim][survey_plan]") {
    const Scenario scenario = parse_scenario(
        "base = \"tsukuba\"\nname = \"rush\"\n"
        "[[occupation]]\nsite = \"No.0\"\ncentre_utc = \"2017-07-16T00:00:00Z\"\nambient_degc = "
        "25\n"
        "[[occupation]]\nsite = \"No.1\"\ncentre_utc = \"2017-07-16T00:05:00Z\"\nambient_degc = "
        "25\n",
        "rush.toml");
    const auto plan = plan_survey(scenario, 1);
    CHECK(plan[0].end < plan[1].start);
    CHECK(seconds_between(plan[1].start, plan[1].end) >= 540.0 - 0.002);
}

TEST_CASE("the plan's tables can be read back", "[sim][survey_plan]") {
    const Scenario scenario = load_scenario("tsukuba");
    const auto plan = plan_survey(scenario, 4);
    const auto truth = text::CsvTable::parse(truth_csv(plan), "truth.csv");
    const auto schedule = text::CsvTable::parse(schedule_csv(plan), "schedule.csv");
    REQUIRE(truth.row_count() == plan.size());
    REQUIRE(schedule.row_count() == plan.size());
    int left_out = 0;
    for (std::size_t row = 0; row < plan.size(); ++row) {
        CHECK(truth.number(row, "gravity_mgal") == plan[row].site.gravity->value());
        CHECK(parse_rfc3339(schedule.cell(row, "start_utc")) == plan[row].start);
        CHECK(parse_rfc3339(schedule.cell(row, "end_utc")) == plan[row].end);
        CHECK(schedule.cell(row, "used") == truth.cell(row, "used"));
        left_out += schedule.cell(row, "used") == "0" ? 1 : 0;
    }
    CHECK(left_out == 3);
}
