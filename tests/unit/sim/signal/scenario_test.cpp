#include "sim/scenario/scenario.hpp"

#include "tests/support/catch.hpp"

#include "protocol/core/input_error.hpp"
#include "protocol/text/csv.hpp"
#include "sim/scenario/embedded_scenarios.hpp"
#include "sim/scenario/survey_plan.hpp"
#include "sim/signal/set_up_truth.hpp"
#include "tests/unit/sim/made_up_scenario.hpp"

using namespace a351;
using namespace a351::sim::plant;
using namespace a351::sim::scenario;
using namespace a351::sim::signal;

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

/// Checks that a scenario, or its plan, is refused in one line that has these parts.
void check_refused(const std::string& toml, const std::vector<std::string>& parts) {
    CAPTURE(toml, parts);
    try {
        static_cast<void>(plan_survey(parse_scenario(toml, "x.toml"), 1));
        FAIL_CHECK("was taken");
    } catch (const InputError& error) {
        for (const std::string& part : parts) CHECK_THAT(error.what(), ContainsSubstring(part));
        CHECK_THAT(error.what(), !ContainsSubstring("\n"));
    }
}
void check_change_refused(const std::string& more, const std::vector<std::string>& parts) {
    check_refused("base = \"tsukuba\"\nname = \"x\"\n" + more, parts);
}

}  // namespace

TEST_CASE("every named scenario loads under its own name") {
    CHECK(scenario_names().size() >= 11);
    for (const std::string_view name : scenario_names()) {
        CHECK(load_scenario(std::string(name)).name == name);
    }
}

TEST_CASE("a scenario overrides only those values of its base that it names") {
    const Scenario base = load_scenario("tsukuba");
    const Scenario tilted = load_scenario("tilted");
    CHECK(base.sensor.horizontal_bias_max_mgal == 0.0);
    CHECK(tilted.sensor.horizontal_bias_max_mgal == 2000.0);
    CHECK(tilted.sensor.levelling_sigma_deg == base.sensor.levelling_sigma_deg);
    CHECK(tilted.occupations.size() == base.occupations.size());
    CHECK(tilted.oven.heater_capacity_j_per_k == base.oven.heater_capacity_j_per_k);
}

TEST_CASE("unknown and missing keys and impossible values are refused by name") {
    const std::string good = tsukuba_toml();
    CHECK_NOTHROW(parse_scenario(good, "day.toml"));
    check_refused(with(good, "white_mgal = 2.5", "white_mgals = 2.5"),
                  {"x.toml:", "sensor.white_mgals", "did you mean white_mgal"});
    check_refused(with(good, "white_mgal = 2.5", ""), {"sensor.white_mgal", "missing"});
    check_refused(with(good, "[sensor]\n", "[sensor]\nextra_mgal = 1.0\n"), {"extra_mgal"});
    check_refused(with(good, "crystal_tau_s = 43.0", "crystal_tau_s = -43.0"),
                  {"crystal_tau_s", "-43"});
    check_refused(with(good, "vehicle_s = [5.0, 20.0]", "vehicle_s = [20.0, 5.0]"), {"vehicle_s"});
    check_refused("base = \"nowhere\"\nname = \"x\"\n", {"nowhere", "tsukuba"});
    CHECK_THROWS_AS(load_scenario("no-such-scenario"), InputError);
}

TEST_CASE("sites and occupations are those of the published tables") {
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

TEST_CASE("the ambient temperature is linear between the occupations and constant outside") {
    const Scenario scenario = load_scenario("tsukuba");
    const auto knots = scenario.ambient_knots();
    const auto& first = scenario.occupations[0];
    const auto& second = scenario.occupations[1];
    CHECK(ambient_at(knots, first.centre).value() == Approx(24.3));
    CHECK(ambient_at(knots, first.centre + (second.centre - first.centre) / 2).value() ==
          Approx(0.5 * (24.3 + 23.4)));
    CHECK(ambient_at(knots, scenario.start() - std::chrono::hours(5)).value() == Approx(24.3));
    CHECK(ambient_at(knots, scenario.end() + std::chrono::hours(5)).value() == Approx(29.2));
}

TEST_CASE("listed ambient temperatures replace those of the occupations") {
    const Scenario scenario = changed(
        "tsukuba",
        "[[ambient]]\nat_h = 1.0\ndegc = 20.0\n"
        "[[ambient]]\nat_utc = \"2017-07-15T23:42:12Z\"\ndegc = 30.0\n");  // 3 h after the start.
    const auto knots = scenario.ambient_knots();
    const auto after = [&](double hours) {
        return ambient_at(knots, scenario.start() + from_seconds(3600.0 * hours)).value();
    };
    CHECK(after(0.0) == 20.0);
    CHECK(after(1.5) == Approx(22.5));
    CHECK(after(9.0) == 30.0);
}

TEST_CASE("a record without occupations has its own limits, one site and no schedule") {
    const Scenario scenario = load_scenario("indoor");
    CHECK(scenario.start() == *parse_rfc3339("2017-06-01T09:00:00Z"));
    CHECK(seconds_between(scenario.start(), scenario.end()) == 12.0 * 3600.0);
    const auto plan = plan_survey(scenario, 1);
    REQUIRE(plan.size() == 1);
    CHECK_FALSE(plan[0].is_occupied);
    CHECK(schedule_csv(plan) == "site,occupation,start_utc,end_utc,used,note\n");
    const auto truth = text::CsvTable::parse(truth_csv(scenario, plan, 1), "truth.csv");
    CHECK(truth.row_count() == 0);

    const Scenario longer = changed("indoor", "[schedule]\nduration_h = 20\n");
    CHECK(longer.start() == scenario.start());
    CHECK(seconds_between(longer.start(), longer.end()) == 20.0 * 3600.0);

    const Scenario survey = changed("indoor", stay("laboratory", "00:00:00"));
    CHECK(plan_survey(survey, 1)[0].is_occupied);
    CHECK(survey.ambient_knots().size() == 3);
}

TEST_CASE("a scenario that contradicts itself is refused in one line") {
    const auto refused = [](const std::string& text, const std::string& part) {
        check_change_refused(text, {"x.toml", part});
    };
    const std::string site =
        "[[site]]\nname = \"A\"\nlongitude_deg = 1\nlatitude_deg = 2\naltitude_m = 3\n"
        "gravity_mgal = 980000\n";
    const std::string fixed = "[schedule]\nstart_utc = \"2020-01-01T00:00:00Z\"\nduration_h = 1\n";
    const std::string air = "[[ambient]]\nat_h = 0\ndegc = 20\n";
    CHECK_NOTHROW(changed("tsukuba", fixed + site + air));
    refused(fixed + air, "site");
    for (const char* name : {"A\\\"", "A,B", "A\\\\", "A\\u0007", "A\\n", "A\\u007f"}) {
        refused(fixed + with(site, "\"A\"", std::string("\"") + name + "\"") + air, "name");
        check_refused("base = \"tsukuba\"\nname = \"" + std::string(name) + "\"\n",
                      {"x.toml", "name"});
    }
    refused(fixed + site, "ambient");
    refused(fixed + "lead_in_h = 3.0\n" + site + air, "lead_in_h");
    refused("[schedule]\nstart_utc = \"2020-01-01T00:00:00Z\"\n" + site + air, "duration_h");
    refused("[schedule]\nstart_utc = \"tomorrow\"\nduration_h = 1\n" + site + air, "start_utc");
    refused(site, "No.0");  // The base's occupations are at sites that are gone.
    refused(air + air, "at_h");
    refused("[[ambient]]\ndegc = 20\n", "at_utc");
    refused("[[ambient]]\nat_h = 1\nat_utc = \"2017-07-16T01:00:00Z\"\ndegc = 20\n", "at_h");
    refused("[[ambient]]\nat_h = 1\ndegc = 60\n", "degc");
    refused("[[lid_open]]\nsite = \"No.1\"\nnumber = 9\noutside_degc = 30\n", "site");
    refused(
        "[[lid_open]]\nfrom_utc = \"2017-07-16T02:00:00Z\"\nto_utc = \"2017-07-16T01:00:00Z\"\n"
        "outside_degc = 30\n",
        "to_utc");
    refused("[schedule]\nlead_in_h = 0.05\n", "lead_in_h");
    refused("[schedule]\nlead_out_min = 5\n", "lead_out_min");
    refused("[schedule]\nsetups = 10\nshortest_s = 60\njitter_s = 125\n", "setups");
    const std::string once = stay("No.1", "00:00:00");
    refused(once + "about_y_deg = [1, 2]\n", "about_y_deg");
    refused(once + once, "number");
    refused(once + "number = 2\n" + once, "centre_utc");
    refused("[line]\njitter_s = 1\n", "jitter_s");
    refused("[clock]\nerror_ppm = 1e6\n", "error_ppm");
    refused("[temperature_error]\nunit_scatter = 1.5\n", "unit_scatter");
    refused("[vibration]\nground_low_hz = 10\nground_high_hz = 5\n", "ground_high_hz");
    refused("[slow_noise]\nflicker_shortest_s = 40000\n", "flicker_longest_s");
    refused("[sensor]\npower_on_before_start_h = 1.9\n", "power_on_before_start_h");
    // The run-in itself is enough.
    CHECK_NOTHROW(changed("tsukuba", "[sensor]\npower_on_before_start_h = 2\n"));
}

TEST_CASE("air around the oven that is not below its set point is refused") {
    const std::string warm = "[oven]\nset_point_degc = 55\n[[ambient]]\nat_h = 1\ndegc = ";
    CHECK_NOTHROW(changed("tsukuba", warm + "54.9\n"));
    check_change_refused(warm + "55\n", {"degc = 55"});
    check_change_refused("[[ambient]]\nat_h = 1\ndegc = 42.5\n",
                         {"degc = 42.5", "oven.set_point_degc = 42.5"});
    check_change_refused("[[lid_open]]\nsite = \"No.1\"\noutside_degc = 43\n", {"outside_degc"});
    check_change_refused("[schedule]\nambient_after_degc = 50\n", {"set_point_degc", "50 degC"});
    // The base's own course is as warm as 34.4 degC.
    check_change_refused("[oven]\nset_point_degc = 34\n", {"set_point_degc", "34.4 degC"});
}

TEST_CASE(
    "an oven with an unstable time step is refused with the bound, and is stable at the bound") {
    check_change_refused("[oven]\nheater_capacity_j_per_k = 1\nheater_body_k_per_w = 0.01\n",
                         {"heater_capacity_j_per_k", "100.08"});
    check_change_refused("[oven]\nbody_capacity_j_per_k = 1\nbody_ambient_k_per_w = 0.5\n",
                         {"body_capacity_j_per_k", "2.2 or more"});
    const Scenario at_the_bound =
        changed("tsukuba",
                "[oven]\nheater_body_k_per_w = 0.01\nheater_capacity_j_per_k = 100.1\n"
                "body_capacity_j_per_k = 100.1\n");
    ThermalPlant plant(at_the_bound.oven, DegC(25.0));
    for (int i = 0; i < 20'000; ++i) plant.step(DegC(25.0));
    CHECK(plant.body().value() > 35.0);
    CHECK(plant.body().value() < 50.0);
}

TEST_CASE("stays that leave no time for their set-ups or for the next stay are refused") {
    // 20 min less 2 min of jitter: 10 set-ups of 108 s, whatever shortest_s says.
    const std::string brief = "[schedule]\nshortest_s = 60\n";
    CHECK_NOTHROW(changed("tsukuba", brief + stay("No.1", "00:00:00",
                                                  "length_s = 1200\n"
                                                  "about_y_deg = [0,0,0,0,0,0,0,0,0,0]\n"
                                                  "about_x_deg = [0,0,0,0,0,0,0,0,0,0]\n")));
    check_change_refused(brief + stay("No.1", "00:00:00",
                                      "length_s = 240\nabout_y_deg = [0, 0, 0]\n"
                                      "about_x_deg = [0, 0, 0]\n"),
                         {"about_y_deg", "No.1 (1)"});
    check_change_refused(brief + "setups = 3\n" + stay("No.1", "00:00:00", "length_s = 240\n"),
                         {"setups", "No.1 (1)"});

    const std::string two_hours =
        "[schedule]\nlead_out_min = 90\n" + stay("No.1", "00:30:00", "length_s = 7200\n");
    check_change_refused(two_hours + stay("No.2", "00:40:00"), {"No.2 (1)", "not over in time"});
    CHECK_NOTHROW(plan_survey(changed("tsukuba", two_hours + stay("No.2", "01:40:00")), 1));

    std::string crowd;  // Cannot be moved apart within the record.
    for (int i = 0; i < 6; ++i) {
        const std::string number = std::to_string(i + 1);
        crowd += stay("No.1", "00:0" + std::to_string(i) + ":00", "number = " + number + "\n");
    }
    check_change_refused(crowd, {"No.1", "further apart"});
}

TEST_CASE("several set-ups share an occupation without a gap, each with its own draws") {
    const Scenario once = load_scenario("tsukuba");
    const Scenario twice = changed("tsukuba", "[schedule]\nsetups = 2\n");
    const auto whole = plan_survey(once, 5);
    const auto halves = plan_survey(twice, 5);
    REQUIRE(halves.size() == 2 * whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const PlannedSetUp &first = halves[2 * i], &second = halves[2 * i + 1];
        CHECK(first.start == whole[i].start);
        CHECK(first.end == second.start);
        CHECK(second.from == second.start);
        CHECK(second.end == whole[i].end);
        CHECK(first.part == 1);
        CHECK(second.part == 2);
        CHECK(second.number == whole[i].number);
        CHECK(std::abs(seconds_between(first.start, first.end) -
                       seconds_between(second.start, second.end)) < 0.003);
        CHECK(first.about_y_rad != second.about_y_rad);
        CHECK(first.placement_mgal != second.placement_mgal);
    }
}

TEST_CASE("listed angles are used for the set-ups") {
    const auto plan = plan_survey(load_scenario("tilt-series"), 5);
    REQUIRE(plan.size() == 12);
    const double two_degrees_rad = 2.0 * 3.14159265358979 / 180.0;
    CHECK(plan[1].about_y_rad == Approx(two_degrees_rad));
    CHECK(plan[1].about_x_rad == 0.0);
    CHECK(plan[4].about_x_rad == Approx(-two_degrees_rad));
    CHECK(plan[6].number == 2);
}

TEST_CASE("a unit's parameters lie within the scatter and depend on the seed") {
    const Scenario scenario = changed("tsukuba", "[temperature_error]\nunit_scatter = 0.25\n");
    double low = 1.0, high = 1.0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const TemperatureErrorParameters unit = drawn_unit(scenario, seed);
        const double share = unit.crystal_tau_s / scenario.error.crystal_tau_s;
        low = std::min(low, share);
        high = std::max(high, share);
        CHECK(unit.clock_mgal_per_degc / scenario.error.clock_mgal_per_degc ==
              Approx(1.0).margin(0.25));
        CHECK(drawn_unit(scenario, seed).warm_up_mgal == unit.warm_up_mgal);
        CHECK(unit.reference_degc == scenario.error.reference_degc);
    }
    CHECK(low > 0.75);
    CHECK(low < 0.77);
    CHECK(high > 1.23);
    CHECK(high < 1.25);
    CHECK(drawn_unit(load_scenario("tsukuba"), 3).crystal_tau_s == 43.0);
}

TEST_CASE(
    "occupations keep order, length and distance for any seed, and if they are close together") {
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
                REQUIRE(plan[i - 1].end < plan[i].from);
                REQUIRE(plan[i].from < plan[i].start);
            }
        }
    }
    const auto rush =
        plan_survey(changed("tsukuba", stay("No.0", "00:00:00") + stay("No.1", "00:14:00")), 1);
    CHECK(rush[0].end < rush[1].start);
    CHECK(seconds_between(rush[1].start, rush[1].end) >= 540.0 - 0.002);
}

TEST_CASE("the plan's tables can be read back") {
    const Scenario scenario = load_scenario("tsukuba");
    const auto plan = plan_survey(scenario, 4);
    const auto truth = text::CsvTable::parse(truth_csv(scenario, plan, 4), "truth.csv");
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
