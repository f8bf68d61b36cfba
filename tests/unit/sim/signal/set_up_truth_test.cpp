#include "sim/signal/set_up_truth.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

#include "protocol/text/csv.hpp"
#include "sim/signal/earth_tide.hpp"
#include "sim/signal/signal_source.hpp"
#include "sim/signal/slow_signal.hpp"
#include "tests/unit/sim/made_up_scenario.hpp"

using namespace a351::sim;
using namespace a351;
using namespace a351::sim::scenario;
using namespace a351::sim::signal;
using namespace std::chrono_literals;

namespace {

struct Norms {
    std::vector<double> means_mgal, deviations_mgal;
};

/// Returns the norms of the samples of each set-up without its first and last minute.
Norms norms_of(const Scenario& scenario, std::uint64_t seed) {
    const wire::DeviceProfile& profile = *wire::find_profile("A351");
    signal::Source source(scenario, profile, seed);
    Norms norms;
    for (const PlannedSetUp& set_up : source.plan()) {
        constexpr std::chrono::minutes kMargin{1};
        constexpr double kAbout = 980'000.0;
        double sum = 0.0, squares = 0.0;
        int count = 0;
        while (*source.next_instant() < set_up.end - kMargin) {
            const TimedSample sample = source.next();
            if (sample.instant < set_up.start + kMargin) continue;
            double square = 0.0;
            for (const std::int32_t axis : sample.values.axes_counts) {
                const double mgal = to_milligal(profile.acceleration(axis)).value();
                square += mgal * mgal;
            }
            sum += std::sqrt(square) - kAbout;
            squares += std::pow(std::sqrt(square) - kAbout, 2);
            ++count;
        }
        norms.means_mgal.push_back(kAbout + sum / count);
        norms.deviations_mgal.push_back(std::sqrt(squares / count - std::pow(sum / count, 2)));
    }
    return norms;
}

double sum_of(const text::CsvTable& table, std::size_t row) {
    double sum = 0.0;
    for (const char* column :
         {"gravity_mgal", "tide_mgal", "bias_mgal", "static_mgal", "dynamic_mgal", "clock_mgal",
          "warm_up_mgal", "placement_mgal", "flicker_mgal", "resonant_mgal", "white_mgal",
          "drift_mgal", "ripple_mgal", "scale_mgal", "tilt_mgal", "burst_mgal",
          "rectification_mgal"}) {
        sum += table.number(row, column);
    }
    return sum;
}

}  // namespace

TEST_CASE("the terms of the truth add up to the mean norm of the samples") {
    // Everything at once: axis biases, two set-ups, traffic without pause, drift, an open lid; and all
    // this with each second set-up in the other face.
    const bool has_two_faces = GENERATE(false, true);
    const Scenario scenario = changed(
        "tilted",
        "[schedule]\nsetups = 2\nlead_in_h = 0.5\n" +
            std::string(has_two_faces
                            ? "faces = \"+-\"\n[sensor]\nscale_share = 0.3\nturn_mgal = 5\n"
                            : "") +
            "[slow_noise]\ndrift_linear_mgal_per_h = 5.0\ndrift_walk_mgal_per_sqrt_h = 1.0\n"
            "resonant_mgal = 1.4\nwhite_20s_mgal = 0.4\n"
            "[vibration]\nvehicles_per_h = 60\nground_mgal = 300\nspike_probability = 0\n" +
            stay("No.5", "00:00:00") +
            "[[occupation]]\nsite = \"No.12\"\ncentre_utc = \"2017-07-16T00:40:00Z\"\n"
            "ambient_degc = 30\n"
            "[[lid_open]]\nsite = \"No.12\"\noutside_degc = 35\n");
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const auto norms = norms_of(scenario, seed).means_mgal;
        const auto table = text::CsvTable::parse(
            truth_csv(scenario, plan_survey(scenario, seed), seed), "truth.csv");
        REQUIRE(norms.size() == 4);
        REQUIRE(table.row_count() == 4);
        for (std::size_t row = 0; row < 4; ++row) {
            CAPTURE(seed, row);
            CHECK(table.number(row, "set_up") == static_cast<double>(row % 2 + 1));
            CHECK(table.number(row, "rectification_mgal") > 0.09);  // 300^2 / g alone.
            // The margin covers the mean of 12 000 samples of ground noise, which has little power
            // below 1 Hz, the cross terms of noise and axis bias, and means by the second.
            const double turn_mgal = has_two_faces ? table.number(row, "turn_mgal") : 0.0;
            CHECK(norms[row] == Approx(sum_of(table, row) + turn_mgal).margin(0.15));
            if (!has_two_faces) continue;
            CHECK((table.number(row, "bias_mgal") < 0.0) == (row % 2 == 1));
            CHECK(table.cell(row, "face") == (row % 2 == 1 ? "-" : "+"));
            CHECK((turn_mgal != 0.0) == (row > 0));
        }
    }
}

TEST_CASE("each term of the truth agrees with its effect on the norm of the samples") {
    // An ideal day with one effect at a time: truth and norm must agree to 0.01 mGal.
    struct Case {
        const char* column;
        const char* toml;
        double least_mgal;
    };
    const auto [column, toml, least_mgal] = GENERATE(values<Case>({
        {"tide_mgal", "", 0.1},
        {"static_mgal", "[temperature_error]\ncrystal_static_mgal_per_degc = -12\n", 0.5},
        {"static_mgal", "[temperature_error]\ncrystal_quadratic_mgal_per_degc2 = 500\n", 0.5},
        {"dynamic_mgal", "[temperature_error]\ncrystal_dynamic_mgal_per_degc = -950\n", 0.05},
        {"clock_mgal", "[temperature_error]\nclock_mgal_per_degc = -20\n", 0.5},
        {"warm_up_mgal", "[temperature_error]\nwarm_up_mgal = 36\n", 0.1},
        {"placement_mgal", "[slow_noise]\nplacement_mgal = 3\n", 0.05},
        {"flicker_mgal", "[slow_noise]\nflicker_mgal = 3\n", 0.05},
        {"resonant_mgal", "[slow_noise]\nresonant_mgal = 3\n", 0.05},
        {"drift_mgal", "[slow_noise]\ndrift_linear_mgal_per_h = 5\n", 0.9},
        {"drift_mgal", "[slow_noise]\ndrift_links_mgal_per_h_per_degc = 30\n", 0.5},
        {"ripple_mgal", "[slow_noise]\nripple_mgal = 2\nripple_period_s = 5000\n", 0.05},
        {"scale_mgal", "[sensor]\nscale = 1.01\n", 0.5},
        {"tilt_mgal", "[sensor]\nlevelling_sigma_deg = 2\nhorizontal_bias_max_mgal = 2000\n", 0.5},
        {"burst_mgal", "[vibration]\nvehicles_per_h = 60\nvehicle_hz = [0.1, 0.1]\n", 0.05},
        {"rectification_mgal",
         "[vibration]\nvehicles_per_h = 60\nvehicle_gal = [20, 20]\nvehicle_hz = [9, 11]\n", 0.5},
    }));
    const auto truth_and_norms = [](const std::string& more) {
        // A day and hour with a tide above 0.1 mGal: new moon of 23 July 2017, Moon and Sun high.
        const Scenario scenario =
            changed("ideal", "[schedule]\nlead_in_h = 0.2\njitter_s = 0\n" + more +
                                 "[[occupation]]\nsite = \"No.5\"\nambient_degc = 25\n"
                                 "centre_utc = \"2017-07-23T03:00:00Z\"\n");
        return std::pair(
            text::CsvTable::parse(truth_csv(scenario, plan_survey(scenario, 1), 1), "truth.csv"),
            norms_of(scenario, 1).means_mgal);
    };
    CAPTURE(column);
    const auto [table, norms] = truth_and_norms(toml);
    CHECK(std::abs(table.number(0, column)) >= least_mgal);
    CHECK(norms[0] == Approx(sum_of(table, 0)).epsilon(0.0).margin(0.01));
    // The Moon and the Sun above pull up: gravity is less.
    CHECK(table.number(0, "tide_mgal") < -0.1);
}

TEST_CASE("an ideal day reads gravity, tide and bias, and its truth has no error") {
    const Scenario scenario = load_scenario("ideal");
    const auto plan = plan_survey(scenario, 3);
    const auto ambient = scenario.ambient_knots();
    const std::vector<SetUpTruth> truth = set_up_truth(scenario, plan, 3);
    const Norms norms = norms_of(scenario, 3);
    REQUIRE(truth.size() == plan.size());
    for (std::size_t k = 0; k < truth.size(); ++k) {
        const SetUpTruth& mean = truth[k];
        const auto term = [&mean](Term t) { return mean.terms_mgal[static_cast<std::size_t>(t)]; };
        CHECK(term(Term::bias) == Approx(1838.0));
        const text::Site& site = plan[k].site;
        const UtcTime middle = plan[k].start + (plan[k].end - plan[k].start) / 2;
        const MilliGal tide = earth_tide(site.latitude, site.longitude, site.altitude, middle,
                                         scenario.tide.gravimetric_factor);
        CHECK(term(Term::tide) == Approx(tide.value()).margin(0.001));
        // 0.1 mGal of dither over at least 21 000 samples, and 0.058 mGal counts: 1 uGal.
        CHECK(norms.means_mgal[k] ==
              Approx(site.gravity->value() + term(Term::tide) + 1838.0).epsilon(0.0).margin(0.004));
        CHECK(norms.deviations_mgal[k] < 0.15);
        double errors_mgal = mean.burst_mgal;
        for (std::size_t i = static_cast<std::size_t>(Term::crystal_static); i < kTermCount; ++i) {
            errors_mgal += std::abs(mean.terms_mgal[i]);
        }
        CHECK(errors_mgal == 0.0);
        CHECK(std::abs(mean.tilt_mgal) < 1e-9);
        CHECK(mean.rectification_mgal < 1e-7);
        constexpr std::chrono::minutes kMargin{1};
        double sum_degc = 0.0;
        int count = 0;
        for (UtcTime t = plan[k].start + kMargin; t < plan[k].end - kMargin; t += 1s, ++count)
            sum_degc += ambient_at(ambient, t).value();
        CHECK(mean.ambient_degc == Approx(sum_degc / count).margin(0.01));
    }
}

TEST_CASE("tilting by two degrees to each side shows the axis bias") {
    const Scenario scenario = load_scenario("tilt-series");
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const auto truth = set_up_truth(scenario, plan_survey(scenario, seed), seed);
        const auto bias_mgal = axis_bias_mgal(scenario, seed);
        // An axis bias acts on the norm in proportion to the share of the norm along that axis.
        // The norm includes the bias of axis z.
        const double gravity_mgal = scenario.sites.front().gravity->value();
        const double sine = std::sin(2.0 * 3.14159265358979 / 180.0) * gravity_mgal /
                            (gravity_mgal + scenario.sensor.bias_mgal);
        CHECK(truth[1].tilt_mgal - truth[2].tilt_mgal ==
              Approx(2.0 * bias_mgal[0] * sine).margin(0.01));
        CHECK(truth[3].tilt_mgal - truth[4].tilt_mgal ==
              Approx(-2.0 * bias_mgal[1] * sine).margin(0.01));
    }
}

TEST_CASE("bias and scale flicker by themselves, and together as much as the scenario says") {
    const Scenario scenario = changed("ideal",
                                      "[schedule]\nfaces = \"+\"\n[sensor]\nscale_share = 0.4\n"
                                      "[slow_noise]\nflicker_mgal = 1.2\n");
    double product = 0.0, of_bias = 0.0, of_scale = 0.0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const auto plan = plan_survey(scenario, seed);
        SlowSignal signal(scenario, plan, seed);
        for (int second = 0; second < 7200; ++second) {
            const SlowValue value = signal.next();
            if (second % 600 != 0) continue;
            const double bias = value.along_z.value() - scenario.sensor.bias_mgal;
            const double scale = value.along_vertical.value() -
                                 plan[value.set_up].site.gravity->value() -
                                 value.terms_mgal[static_cast<std::size_t>(Term::tide)];
            CHECK(value.terms_mgal[static_cast<std::size_t>(Term::flicker)] ==
                  Approx(bias + scale).margin(1e-6));
            product += bias * scale;
            of_bias += bias * bias;
            of_scale += scale * scale;
            ++count;
        }
    }
    CHECK(std::sqrt((of_bias + of_scale) / count) == Approx(1.2).epsilon(0.1));
    CHECK(std::sqrt(of_scale / of_bias) == Approx(0.4 / 0.6).epsilon(0.15));
    CHECK(std::abs(product / count) < 0.1);  // one flicker: 0.66
}
