// Networks adjusted by the program: it finds what the readings determine and reports what they
// leave open.
#include <cmath>
#include <map>
#include "protocol/core/utc_time.hpp"
#include "tests/unit/command/run_command.hpp"

using namespace a351;

namespace {

using Loop = std::vector<std::string>;

const std::vector<std::string> kStations{"B", "S1", "S2", "S3", "S4"};
const Loop kDay{"B", "S1", "S2", "S3", "B", "S4", "S2", "S1", "B", "S4", "S3", "B"};
constexpr double kQuadratic_mgal_per_h2 = 0.08;
constexpr double kDrift_mgal_per_h = 0.4;
constexpr double kSlope_mgal_per_degc = -29.0;

double gravity_mgal(const std::string& site) {
    return 979800.0 + 7.0 * (site == "B" ? 0.0 : site.back() - '0');
}

/// Writes sites of which only B has a known gravity; none has one without a datum.
void write_sites(const test::TemporaryDirectory& folder, bool has_datum = true) {
    std::string csv = "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n";
    for (const std::string& site : kStations)
        csv += site + ",140,36,100," +
               (site == "B" && has_datum ? text::shortest(gravity_mgal(site)) : "") + "\n";
    folder.write("sites.csv", csv);
}

/// Writes one reading every 45 min and one loop per day; temperature and drift of the instrument
/// continue between days.
/// @param admittance_mgal_per_hpa  effect of the air pressure; 0: the table has none.
void write_readings(const test::TemporaryDirectory& folder, const std::vector<Loop>& loops,
                    bool is_steady = false, double admittance_mgal_per_hpa = 0.0) {
    const bool has_pressure = admittance_mgal_per_hpa != 0.0;
    std::string csv =
        "site,occupation,time_utc,earth_tide_mgal,acceleration_mgal,temperature_degc" +
        std::string(has_pressure ? ",pressure_hpa\n" : "\n");
    std::map<std::string, int> stays;
    for (std::size_t day = 0; day < loops.size(); ++day) {
        for (std::size_t i = 0; i < loops[day].size(); ++i) {
            const std::string& site = loops[day][i];
            const UtcTime time = parse_rfc3339("2020-05-01T00:00:00Z").value() +
                                 std::chrono::minutes(45 * i) + std::chrono::days(day);
            const double h = 24.0 * static_cast<double>(day) + 0.75 * static_cast<double>(i);
            const double degc = is_steady ? 42.5 : 42.5 + 0.3 * std::sin(1.7 * h);
            const double pressure_hpa = 1000.0 + 12.0 * std::sin(2.3 * h);
            const double reading =
                gravity_mgal(site) + 1850.0 + admittance_mgal_per_hpa * pressure_hpa +
                kSlope_mgal_per_degc * (degc - 42.6) + kDrift_mgal_per_h * (h - 5.0) +
                kQuadratic_mgal_per_h2 * (h - 5.0) * (h - 5.0);
            csv += site + ',' + std::to_string(++stays[site]) + ',' + to_rfc3339(time) + ",0," +
                   text::shortest(reading) + ',' + text::shortest(degc) +
                   (has_pressure ? ',' + text::shortest(pressure_hpa) : "") + '\n';
        }
    }
    folder.write("readings.csv", csv);
}

Outcome adjust(const test::TemporaryDirectory& folder, const std::string& options = "") {
    return run(folder,
               "table --sites sites.csv --observations readings.csv --model network " + options);
}

/// Returns the coefficients of the result, by name.
std::map<std::string, double> coefficients(const test::TemporaryDirectory& folder) {
    const auto json = json_of(folder);
    std::map<std::string, double> found;
    for (const auto& one : json["coefficients"]) found[one["name"]] = one["value"];
    return found;
}

}  // namespace

TEST_CASE("table finds a known quadratic drift and the unknown stations of a network") {
    const test::TemporaryDirectory folder;
    write_sites(folder);
    write_readings(folder, {kDay});
    const Outcome outcome = adjust(folder, "--drift-degree 2");
    CHECK(outcome.status == 0);
    CHECK_THAT(outcome.errors, ContainsSubstring("the tide given is 0 throughout"));
    auto found = coefficients(folder);
    // Readings of 1e6 mGal are rounded to 1.2e-10 mGal, and the day lasts eight hours.
    CHECK(found["time2_mgal_per_h2"] == Approx(kQuadratic_mgal_per_h2).epsilon(0).margin(1e-8));
    CHECK(found["time_mgal_per_h"] == Approx(kDrift_mgal_per_h).epsilon(0).margin(1e-8));
    CHECK(found["temperature_mgal_per_degc"] ==
          Approx(kSlope_mgal_per_degc).epsilon(0).margin(1e-8));
    const auto stations = table_of(folder, "result/stations.csv");
    REQUIRE(stations.row_count() == kStations.size());
    for (std::size_t row = 0; row < stations.row_count(); ++row)
        CHECK(stations.number(row, "gravity_mgal") ==
              Approx(gravity_mgal(stations.cell(row, "site"))).epsilon(0).margin(1e-6));

    // A linear drift model leaves the curvature of the drift in the stations.
    CHECK(adjust(folder, "--out line").status == 0);
    const auto bent = table_of(folder, "line/stations.csv");
    CHECK(std::abs(bent.number(1, "gravity_mgal") - gravity_mgal("S1")) > 0.1);
}

TEST_CASE("table fits the whole effect of the air pressure, not what another value has left") {
    const test::TemporaryDirectory folder;
    write_sites(folder);
    write_readings(folder, {kDay}, false, -0.0005);
    const Outcome outcome = adjust(folder, "--drift-degree 2 --fit-admittance");
    CAPTURE(outcome.errors);
    REQUIRE(outcome.status == 0);
    CHECK(coefficients(folder)["admittance_mgal_per_hpa"] ==
          Approx(-0.0005).epsilon(0).margin(1e-7));
}

TEST_CASE("a network with something undetermined is refused in one line that names it") {
    const test::TemporaryDirectory folder;
    const struct {
        bool has_datum;
        std::vector<Loop> loops;
        std::vector<std::string> parts;
    } cases[]{
        {false, {kDay}, {"no datum", "allowed: gravity_mgal of at least one occupied station"}},
        {true,
         {{"B", "S1", "B", "S1"}, {"S2", "S3", "S2", "S3"}},
         {"unconnected", "joins a datum to S2, S3", "a datum in every group"}},
        {true,
         {{"B", "S1", "S2", "S3", "S4"}},
         {"every station is occupied only once", "time_mgal_per_h", "smaller drift_degree"}}};
    for (const auto& expected : cases) {
        write_sites(folder, expected.has_datum);
        write_readings(folder, expected.loops);
        const Outcome outcome = adjust(folder);
        CHECK_THAT(outcome.errors, StartsWith("a351-correct: model = network: "));
        for (const std::string& part : expected.parts) check_refused(outcome, part);
        CHECK(outcome.output.empty());
        CHECK_FALSE(std::filesystem::exists(folder.path() / "result"));
    }
}

TEST_CASE("a network with a weak part is adjusted, and text and report name the weakness") {
    const test::TemporaryDirectory folder;
    write_sites(folder);
    for (const auto& [loop, is_steady, words] :
         {std::tuple(
              Loop{"B", "S1", "B", "S1", "S2", "S3", "S2", "S3"}, false,
              std::string("connected with a datum only by the instrument's constant and drift")),
          {{"B", "S1", "S2", "S3", "S4", "S1", "S2", "S3", "S4"},
           false,
           "practically uncontrolled (redundancy below 0.1), a blunder there cannot be found: B "
           "(1)"},
          {kDay, true, "the temperature does not vary between the readings"}}) {
        CAPTURE(words);
        write_readings(folder, {loop}, is_steady);
        const Outcome outcome = adjust(folder, "--verbose");
        CHECK(outcome.status == 0);
        CHECK_THAT(outcome.output, ContainsSubstring(words));
        CHECK_THAT(text::read_text_file(folder.path() / "result/report.html"),
                   ContainsSubstring(words.substr(0, 40)));
    }
}

TEST_CASE("t-drift refuses a constant temperature, and a drift from one base occupation") {
    const test::TemporaryDirectory folder;
    write_sites(folder);
    write_readings(folder, {{"B", "S1", "S2", "B", "S3", "B"}}, true);
    const std::string table = "table --sites sites.csv --observations readings.csv --model ";
    check_refused(run(folder, table + "t-drift"), "temperature, rate and time vary independently");
    const Outcome automatic = run(folder, table + "auto --verbose");
    CHECK(automatic.status == 0);
    CHECK_THAT(automatic.output, ContainsSubstring("model network (chosen because the known "
                                                   "stations do not allow to compare models)"));
    write_readings(folder, {{"B", "S1", "S2", "S3", "S1"}});
    check_refused(run(folder, table + "t-drift"), "1 rows with a reference do not determine it");
}
