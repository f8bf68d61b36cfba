#include "corrector/history/unit_history.hpp"

#include <fmt/core.h>

#include <cmath>

#include "corrector/figure/history_figure.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_directory.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::history;

namespace {

/// Returns the part of a result.json that a history reads.
std::string result_of(const std::string& serial, const std::string& day, double constant_mgal) {
    return fmt::format(R"({{"settings": {{"serial_number": {}, "name": "{}"}}, "model": "day",
"cross_validated": {{"loso_mgal": 1.5}}, "goodness_of_fit": {{"uncertainty_factor": 1.0}},
"coefficients": [{{"name": "constant_mgal", "value": {}, "standard_error": 2.0}},
{{"name": "scale", "value": 1.001, "standard_error": null}}, {{"name": "foreign", "value": 1, "standard_error": 1}}],
"occupations": [{{"start_utc": "{}T02:00:00.000Z"}}, {{"start_utc": "{}T01:00:00.000Z"}}]}})",
                       serial, day, constant_mgal, day, day);
}

std::string refusal_of(const std::vector<std::filesystem::path>& results) {
    try {
        (void)read_unit_days(results);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("days of several units are listed by unit and time", "[history]") {
    const test::TemporaryDirectory scratch;
    const std::vector<std::filesystem::path> files{
        scratch.write("c.json", result_of("\"B\"", "2026-05-01", 10.0)),
        scratch.write("b.json", result_of("\"A\"", "2026-06-02", 13.0)),
        scratch.write("a/result.json", result_of("\"A\"", "2026-05-02", 11.0)).parent_path()};
    const std::vector<UnitDay> days = read_unit_days(files);
    REQUIRE(days.size() == 3);
    CHECK(days[0].name == "2026-05-02");
    CHECK(to_rfc3339(days[0].start) == "2026-05-02T01:00:00Z");
    CHECK(days[1].name == "2026-06-02");
    CHECK(days[2].serial_number == "B");
    const std::string csv = csv_table(unit_day_columns(), days);
    CHECK_THAT(csv, StartsWith("serial_number,start_utc,name,loso_mgal,uncertainty_factor,"
                               "constant_mgal,u_constant_mgal,temperature_mgal_per_degc,"));
    CHECK_THAT(csv, ContainsSubstring("A,2026-05-02T01:00:00.000Z,2026-05-02,1.500000,1.000000,"
                                      "11.000000,2.000000,,,"));

    const std::vector<TermSummary> terms = summarise(days);
    REQUIRE(terms.size() == 4);  // Constant and scale of each unit.
    CHECK(terms[0].term == "constant_mgal");
    CHECK(terms[0].day_count == 2);
    CHECK(terms[0].mean == Approx(12.0));
    CHECK(*terms[0].scatter == Approx(std::sqrt(2.0)));
    CHECK(*terms[0].rms_u == Approx(2.0));
    CHECK(terms[1].term == "scale");
    CHECK_FALSE(terms[1].rms_u.has_value());
    CHECK(terms[2].serial_number == "B");
    CHECK_FALSE(terms[2].scatter.has_value());

    const figure::Figure figure = figure::history_figure(days);
    CHECK_THAT(figure.data, ContainsSubstring("2026-06-02T01:00:00Z 13.00000 2.00000"));
    CHECK_THAT(figure.script, ContainsSubstring("Constant mGal"));
    CHECK_THAT(figure.script, !ContainsSubstring("Placement mGal"));  // No day has it.
    CHECK_THAT(figure.script,
               ContainsSubstring("set xtics 604800"));  // 32 days in at most 6 dates.
}

TEST_CASE("a file that is no result, or of a day that was given, is refused by name", "[history]") {
    const test::TemporaryDirectory scratch;
    const auto good = scratch.write("good.json", result_of("\"A\"", "2026-05-01", 10.0));
    const auto same = scratch.write("same.json", result_of("\"A\"", "2026-05-01", 11.0));
    CHECK_THAT(refusal_of({good, same}), ContainsSubstring("same.json: the same day of unit A"));
    const std::string allowed = "allowed: the result.json of a survey corrected with the model day";
    for (const std::string& text :
         {std::string("{"), std::string("[]"), std::string(R"({"settings": {}})"),
          result_of("\"A\"", "2026-13-01", 1.0), result_of("7", "2026-05-01", 1.0)})
        CHECK_THAT(refusal_of({scratch.write("bad.json", text)}),
                   ContainsSubstring("bad.json: not such a file (") && EndsWith(allowed));
    CHECK_THAT(
        refusal_of({scratch.write("bad.json", result_of("null", "2026-05-01", 1.0))}),
        ContainsSubstring("bad.json: serial_number: not in the metadata") && EndsWith(allowed));
    std::string other = result_of("\"A\"", "2026-05-01", 1.0);
    other.replace(other.find("\"day\""), 5, "\"t-rate\"");
    CHECK_THAT(refusal_of({scratch.write("bad.json", other)}),
               ContainsSubstring("bad.json: model = t-rate"));
    CHECK_THAT(refusal_of({scratch.path() / "none.json"}), ContainsSubstring("none.json"));
    CHECK_THAT(refusal_of({scratch.path()}), ContainsSubstring("result.json"));
}
