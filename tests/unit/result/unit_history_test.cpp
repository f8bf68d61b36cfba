#include "corrector/result/unit_history.hpp"

#include <cmath>

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::result;

namespace {

/// Returns a day that the whole-day model corrected, with two readings.
model::SurveyCorrection day_of(const std::string& date, double constant_mgal) {
    model::SurveyCorrection day;
    for (const char* const hour : {"T02:00:00Z", "T01:00:00Z"})
        day.rows.emplace_back().row.start = parse_rfc3339(date + hour).value();
    day.own = model::WholeDayPart{};
    day.score.loso_mgal = 1.5;
    day.coefficients = {{"constant_mgal", constant_mgal, 2.0},
                        {"scale", 1.001, std::nullopt},
                        {"foreign", 1.0, 1.0}};
    return day;
}

}  // namespace

TEST_CASE("days of several units are listed by unit and time") {
    const auto of_b = day_of("2026-05-01", 10.0), late = day_of("2026-06-02", 13.0),
               early = day_of("2026-05-02", 11.0);
    const std::vector<UnitDay> days =
        unit_days({{"b", "B", &of_b}, {"late", "A", &late}, {"early", "A", &early}});
    REQUIRE(days.size() == 3);
    CHECK(days[0].name == "early");
    CHECK(to_rfc3339(days[0].start) == "2026-05-02T01:00:00Z");
    CHECK(days[1].name == "late");
    CHECK(days[2].serial_number == "B");
    const std::string csv = csv_table(unit_day_columns(), days);
    CHECK_THAT(csv, StartsWith("serial_number,start_utc,name,loso_mgal,uncertainty_factor,"
                               "constant_mgal,u_constant_mgal,temperature_mgal_per_degc,"));
    CHECK_THAT(csv, ContainsSubstring("A,2026-05-02T01:00:00.000Z,early,1.500000,1.000000,"
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
}

TEST_CASE("a day of another model, or of a unit that is not known, is in no history") {
    const auto day = day_of("2026-05-01", 10.0);
    auto linear = day;
    linear.own = std::monostate();
    CHECK(unit_days({{"linear", "A", &linear}, {"unknown", "", &day}}).empty());
}
