#include "corrector/reduction/row_reduction.hpp"

#include "corrector/reduction/plate_and_pressure.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::reduction;

namespace {

const std::vector<text::Site> kSites{
    {"base", Degrees(140.0), Degrees(36.0), Metres(0.0), std::nullopt},
    {"peak", Degrees(140.0), Degrees(36.0), Metres(1000.0), std::nullopt}};

reading::SurveyRow row(const std::string& site, const std::string& time) {
    reading::SurveyRow row;
    row.site = site;
    row.time = parse_rfc3339("2026-03-01T" + time + "Z").value();
    row.acceleration = MilliGal(979000.0);
    return row;
}

}  // namespace

TEST_CASE("a reading above the mark is raised by the gradient of its site") {
    std::vector<reading::SurveyRow> rows{row("base", "01:00:00"), row("peak", "02:00:00")};
    rows[0].instrument_height = Metres(0.25);
    rows[1].instrument_height = Metres(0.5);
    CHECK(reduce_rows(rows, kSites, {{"peak", 0.4}}, {}).empty());
    CHECK(rows[0].acceleration.value() == Approx(979000.07715).epsilon(0.0).margin(1e-9));
    CHECK(rows[1].acceleration.value() == Approx(979000.2).epsilon(0.0).margin(1e-9));
    CHECK(rows[1].measured().value() == Approx(979000.0).epsilon(0.0).margin(1e-9));
    CHECK_FALSE(rows[0].pressure_correction);
}

TEST_CASE("an absolute value at its transfer height comes down to that of the mark") {
    // tests/golden/usgs/rg26_2017-12-01: at 100 cm, gradient -3.000 uGal/cm; absolute.csv: the mark.
    std::vector<reading::SurveyRow> rows{row("base", "01:00:00")};
    rows[0].acceleration = MilliGal(979197.57592);
    rows[0].instrument_height = Metres(1.0);
    CHECK(reduce_rows(rows, kSites, {{"base", 0.3}}, {}).empty());
    CHECK(rows[0].acceleration.value() == Approx(979197.8759).epsilon(0.0).margin(0.00005));
}

TEST_CASE("the height of the survey serves readings without one, and a bin has that of its row") {
    std::vector<reading::SurveyRow> rows{row("base", "01:00:00"), row("peak", "02:00:00")};
    rows[1].instrument_height = Metres(0.0);
    reading::DayRecord day{{TimeSeries<DegC>{rows[0].time, Hertz(1.0), {42.5, 42.5}}, {}}, {}};
    day.bins.resize(2);
    day.bins[1].set_up = 1;
    static_cast<void>(reduce_rows(rows, kSites, {}, {.height = Metres(1.0), .pressure = {}}, &day));
    CHECK(rows[0].height_correction->value() == Approx(0.3086));
    CHECK(rows[1].height_correction->value() == 0.0);
    CHECK(day.bins[0].reading.value() == Approx(0.3086));
    CHECK(day.bins[1].reading.value() == 0.0);
}

TEST_CASE("more air than in the standard atmosphere pulls up, and the reading is raised") {
    std::vector<reading::SurveyRow> rows{row("base", "01:00:00"), row("peak", "02:00:00")};
    rows[0].pressure_hpa = 1023.25;
    rows[1].pressure_hpa = normal_pressure_hpa(Metres(1000.0)) - 20.0;
    CHECK(reduce_rows(rows, kSites, {}, {}).empty());
    CHECK(rows[0].pressure_correction->value() == Approx(0.003));
    CHECK(rows[1].pressure_correction->value() == Approx(-0.006));
    CHECK(rows[1].excess_pressure_hpa.value() == Approx(-20.0));
    CHECK(rows[0].acceleration.value() == Approx(979000.003).epsilon(0.0).margin(1e-9));
}

TEST_CASE("a reading without height or pressure beside others is named") {
    std::vector<reading::SurveyRow> rows{row("base", "01:00:00"), row("peak", "02:00:00")};
    rows[0].instrument_height = Metres(0.25);
    rows[0].pressure_hpa = 1000.0;
    const auto warnings = reduce_rows(rows, kSites, {}, {});
    REQUIRE(warnings.size() == 2);
    CHECK(warnings[0] ==
          "1 of 2 readings have no instrument_height_m: they are taken as at the mark");
    CHECK_THAT(warnings[1], ContainsSubstring("standard atmosphere"));
    CHECK(rows[1].height_correction->value() == 0.0);
    CHECK(rows[1].pressure_correction->value() == 0.0);
}

TEST_CASE("a pressure reduced to sea level is refused at a mountain") {
    std::vector<reading::SurveyRow> rows{row("peak", "02:00:00")};
    rows[0].pressure_hpa = 1053.0;
    CHECK_THROWS_WITH(reduce_rows(rows, kSites, {}, {}),
                      ContainsSubstring("peak (1): pressure_hpa = 1053") &&
                          ContainsSubstring("not reduced to sea level"));
}

TEST_CASE("a pressure at a site without an altitude is refused") {
    std::vector<reading::SurveyRow> rows{row("base", "01:00:00")};
    rows[0].pressure_hpa = 1003.0;
    auto sites = kSites;
    sites[0].has_altitude = false;
    CHECK_THROWS_WITH(reduce_rows(rows, sites, {}, {}),
                      ContainsSubstring("base: its readings have an air pressure") &&
                          ContainsSubstring("altitude_m"));
}

TEST_CASE("a reading is not reduced for the pressure if the admittance is fitted") {
    std::vector<reading::SurveyRow> rows{row("base", "01:00:00")};
    const ReductionChoice fitted{.height = {}, .pressure = {}, .is_admittance_fitted = true};
    CHECK_THROWS_WITH(reduce_rows(rows, kSites, {}, fitted),
                      ContainsSubstring("cannot be fitted without the air pressure of base"));
    std::vector<reading::SurveyRow> partly{rows[0], row("peak", "02:00:00")};
    partly[0].pressure_hpa = 1023.25;
    CHECK_THROWS_WITH(reduce_rows(partly, kSites, {}, fitted),
                      ContainsSubstring("cannot be fitted without the air pressure of peak"));
    rows[0].pressure_hpa = 1023.25;
    static_cast<void>(reduce_rows(rows, kSites, {}, fitted));
    CHECK(rows[0].pressure_correction->value() == 0.0);
    CHECK(rows[0].excess_pressure_hpa.value() == Approx(10.0));
}

TEST_CASE("a file of the pressure serves readings without one") {
    const test::TemporaryDirectory folder;
    std::vector<reading::SurveyRow> rows{row("base", "01:00:00"), row("base", "01:30:00")};
    rows[0].pressure_hpa = 990.0;
    const auto file = folder.write(
        "p.csv", "time,pressure_hpa\n2026-03-01T00:00:00Z,1000\n2026-03-01T02:00:00Z,1000\n");
    static_cast<void>(reduce_rows(rows, kSites, {}, {.height = {}, .pressure = file}));
    CHECK(rows[0].pressure_hpa == 990.0);
    CHECK(rows[1].pressure_hpa == 1000.0);
}

TEST_CASE("a file of the pressure of another day is refused") {
    const test::TemporaryDirectory folder;
    std::vector<reading::SurveyRow> rows{row("base", "01:00:00")};
    const auto file = folder.write(
        "p.csv", "time,pressure_hpa\n2026-02-01T00:00:00Z,1000\n2026-02-01T01:00:00Z,1000\n");
    CHECK_THROWS_WITH(reduce_rows(rows, kSites, {}, {.height = {}, .pressure = file}),
                      ContainsSubstring("no pressure at the time of any reading"));
}

TEST_CASE("gradients are read where the table has them, and a wrong sign is refused") {
    const test::TemporaryDirectory folder;
    const auto gradients =
        read_gradients(folder.write("sites.csv", "site,gradient_mgal_per_m\nbase,\npeak,0.35\n"));
    CHECK(gradients == Gradients{{"peak", 0.35}});
    CHECK(read_gradients(folder.write("none.csv", "site\nbase\n")).empty());
    CHECK_THROWS_WITH(
        read_gradients(folder.write("sign.csv", "site,gradient_mgal_per_m\nbase,-0.3086\n")),
        ContainsSubstring("gradient_mgal_per_m = -0.3086"));
}
