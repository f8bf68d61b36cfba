#include "corrector/reading/start_up_findings.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::reading;

namespace {

UtcTime at(const char* hour) {
    return parse_rfc3339(std::string("2020-05-01T") + hour + ":00Z").value();
}

events::Event test_event(const char* hour, const char* result, const char* unit = "00000042") {
    return {"start_up_test", at(hour), {}, {}, {{"result", result}, {"serial_number", unit}}};
}

}  // namespace

TEST_CASE("a start-up test that was not passed is found in the times until the next test") {
    const std::vector<events::Event> events{test_event("12:00", "passed"),
                                            test_event("08:00", "HARD_ERR"),
                                            test_event("14:00", "unknown")};
    const auto morning = start_up_findings(events, "00000042", at("09:00"), at("11:00"));
    REQUIRE(morning.size() == 1);
    CHECK(morning[0].kind == FindingKind::start_up_test);
    CHECK_FALSE(is_remark(morning[0]));
    CHECK(morning[0].time == at("08:00"));
    CHECK(morning[0].text ==
          "sensor 00000042 failed its start-up test at 2020-05-01T08:00:00Z (HARD_ERR): do not "
          "trust the "
          "readings after it");
    CHECK(start_up_findings(events, "00000042", at("06:00"), at("08:00")).empty());
    CHECK(start_up_findings(events, "00000042", at("12:00"), at("14:00")).empty());
    CHECK(start_up_findings(events, "00000042", at("11:00"), at("15:00")).size() == 2);
    CHECK(start_up_findings(events, "00000042", at("14:30"), at("15:00"))[0].code ==
          "start_up_test_unknown");
}

TEST_CASE("a start-up test is found for the sensor that was tested only") {
    const std::vector<events::Event> events{test_event("08:00", "HARD_ERR", "00000001"),
                                            test_event("10:00", "passed", "00000002"),
                                            test_event("12:00", "HARD_ERR", "00000001")};
    const auto found = [&](const char* unit, const char* from, const char* to) {
        std::vector<std::string> hours;
        for (const Finding& finding : start_up_findings(events, unit, at(from), at(to)))
            hours.push_back(to_rfc3339(*finding.time).substr(11, 5));
        return hours;
    };
    using Hours = std::vector<std::string>;
    CHECK(found("00000001", "09:00", "13:00") == Hours{"08:00", "12:00"});
    CHECK(found("00000001", "11:00", "11:30") == Hours{"08:00"});  // not passed by the other one
    CHECK(found("00000002", "07:00", "13:00").empty());
    CHECK(found("", "11:00", "13:00") == Hours{"12:00"});  // a record without serial numbers
}
