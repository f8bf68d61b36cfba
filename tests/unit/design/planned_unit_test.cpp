#include "corrector/design/planned_unit.hpp"

#include <fmt/core.h>

#include "corrector/whole_day/unit_posterior.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::design;

namespace {

/// Returns a result.json with a diagonal covariance.
std::string result_json(const std::string& model = "day", double covariance = 0.01) {
    std::string names, rows;
    const auto& parameters = whole_day::unit_parameters();
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        names += fmt::format("{}\"{}\"", k == 0 ? "" : ",", parameters[k].name);
        rows += k == 0 ? "[" : ",[";
        for (std::size_t l = 0; l < parameters.size(); ++l)
            rows += fmt::format("{}{}", l == 0 ? "" : ",", k == l ? covariance : 0.0);
        rows += "]";
    }
    return fmt::format(
        R"({{"model": "{}", "unit": {{"parameters": [{}], "values": [3.8, 7.9, -12, -20, 11, 100, -50],)"
        R"( "covariance": [{}], "noise": {{"placement_mgal": 0.9, "flicker_mgal": 1.1, "white_mgal": 0.2}}}},)"
        R"( "occupations": [)"
        R"({{"time_utc": "2026-05-01T00:00:00Z", "temperature_degc": 42.5, "mean_x_g": 0.001, "mean_y_g": 0.0}},)"
        R"({{"time_utc": "2026-05-01T04:00:00Z", "temperature_degc": 42.9, "mean_x_g": 0.001, "mean_y_g": 0.002}}]}})",
        model, names, rows);
}

std::string refusal_of_unit(const std::string& text) {
    const test::TemporaryDirectory folder;
    try {
        static_cast<void>(planned_unit(folder.write("result.json", text)));
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

}  // namespace

TEST_CASE("an earlier day gives response, noise, temperature and levelling") {
    const test::TemporaryDirectory folder;
    const PlannedUnit unit = planned_unit(folder.write("result.json", result_json()));
    CHECK(unit.noise.placement_mgal == 0.9);
    CHECK(unit.noise.flicker_mgal == 1.1);
    CHECK(unit.noise.white_mgal == 0.2);
    CHECK(unit.walk_degc_per_sqrt_h == Approx(0.4 / 2.0));
    CHECK(unit.tilt_g == Approx(0.001));
    using whole_day::DayPriors;
    using whole_day::DayTerm;
    CHECK(unit.priors.mean(0) == 3.8);
    CHECK(unit.priors.mean(DayPriors::place_of(DayTerm::fast)) == 11.0);
    CHECK(unit.priors.mean(DayPriors::place_of(DayTerm::y)) == -50.0);
    CHECK(unit.priors.factor(DayPriors::place_of(DayTerm::x), DayPriors::place_of(DayTerm::x)) ==
          Approx(0.1));
    CHECK(unit.priors.bias_factor == 1.0);
    // Terms that a day does not share with others keep their usual prior.
    const DayPriors usual = whole_day::usual_day_priors();
    const auto drift = DayPriors::place_of(DayTerm::drift);
    CHECK(unit.priors.factor(drift, drift) == usual.factor(drift, drift));
    CHECK(unit.origin == "the day of 2026-05-01");
}

TEST_CASE("a file that is no result of the whole-day model is refused") {
    const std::string allowed =
        "; allowed: the result.json of a survey corrected with the model day";
    CHECK_THAT(refusal_of_unit(result_json("t-rate")),
               ContainsSubstring("result.json: model = t-rate") && EndsWith(allowed));
    for (const std::string& text :
         {std::string("{}"), std::string("[1]"), std::string("x"), result_json("day", -1.0)}) {
        CAPTURE(text);
        CHECK_THAT(refusal_of_unit(text),
                   ContainsSubstring("not such a file (") && EndsWith(allowed));
    }
}

TEST_CASE("a calibration gives the priors that a survey with it has") {
    const test::TemporaryDirectory folder;
    unit::Calibration calibration;
    calibration.serial_number = "7";
    calibration.program = "test";
    calibration.valid_from = *parse_rfc3339("2026-01-01T00:00:00Z");
    calibration.axis_bias.emplace();
    calibration.axis_bias->values << 300.0, -200.0;
    const PlannedUnit unit = planned_unit(folder.write("unit.toml", unit::to_toml(calibration)));
    CHECK(unit.origin == "calibration of unit 7");
    const auto x = whole_day::DayPriors::place_of(whole_day::DayTerm::x);
    CHECK(unit.priors.mean(x) == Approx(300.0).epsilon(1e-3));
    CHECK(unit.noise.placement_mgal == whole_day::kUsualNoise.placement_mgal);
}
