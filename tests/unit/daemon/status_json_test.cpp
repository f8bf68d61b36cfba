#include <limits>

#include "tests/unit/daemon/asked_page.hpp"

using namespace a351;
using namespace a351::daemon;

TEST_CASE("every fixed field of the status is there before the first sample") {
    Page page;
    const auto status = page.ask(get("/api/status"));
    for (const char* field :
         {"/api", "/version", "/journaled", "/archived", "/oven", "/counters/gaps",
          "/counters/checksum_errors", "/counters/bytes_skipped", "/counters/duplicates",
          "/device/port", "/disk/free_bytes", "/disk/reserve", "/disk/longest_sync_ms"}) {
        CAPTURE(field);
        CHECK(status.contains(json::json_pointer(field)));
    }
    CHECK(is(status, "/level", R"("warning")"));
    CHECK(is(status, "/signal/word", R"("no_data")"));
    CHECK(is(status, "/session", "null"));
    CHECK(is(status, "/received", "null"));
    CHECK(is(status, "/occupation", "null"));
    CHECK(is(status, "/sample", "null"));
    CHECK(is(status, "/timing/state", R"("unlocked")"));
    CHECK(is(status, "/timing/uncertainty_ms", "null"));
    CHECK(is(status, "/details/state", R"("no data")"));
    CHECK(status["details"]["reasons"].size() == 1);
}

TEST_CASE("the status gives the oven's values with units, and null for a doubtful temperature") {
    Page page;
    CHECK(page.ask(get("/api/status"))["oven"] == json{{"state", "disabled"}});
    fill(page.status);
    CHECK(page.ask(get("/api/status"))["oven"] == json{{"state", "answering"},
                                                       {"trouble", ""},
                                                       {"port", "/dev/pts/5"},
                                                       {"process_value_degc", 42.5},
                                                       {"set_point_degc", 43.0},
                                                       {"heating_percent", 25.0},
                                                       {"status_word", 256},
                                                       {"has_input_error", false},
                                                       {"decimals", 1},
                                                       {"age_s", 0.4},
                                                       {"is_stale", false},
                                                       {"polls",
                                                        {{"answered", 7},
                                                         {"timed_out", 0},
                                                         {"bad_crc", 2},
                                                         {"exception", 0},
                                                         {"other_unit", 0},
                                                         {"malformed", 0},
                                                         {"no_port", 0}}}});
    page.status.oven->values->process_value.reset();
    page.status.oven->values->status = oven::kInputError;
    const auto doubtful = page.ask(get("/api/status"));
    CHECK(is(doubtful, "/oven/process_value_degc", "null"));
    CHECK(is(doubtful, "/oven/has_input_error", "true"));
    page.status.oven->values.reset();
    page.status.oven->age.reset();
    const auto silent = page.ask(get("/api/status"));
    for (const char* field : {"process_value_degc", "set_point_degc", "heating_percent",
                              "status_word", "has_input_error", "age_s"})
        CHECK(silent["oven"].at(field).is_null());
}

TEST_CASE("the status carries values with their units") {
    Page page;
    fill(page.status);
    page.status.level = status::Status::Level::warning;
    page.status.verdict.state = verdict::State::stable;
    page.status.reasons = {"disk nearly full"};
    page.status.timing_state = timing::State::locked;
    page.status.clock_step = {page.status.now, page.status.now - std::chrono::seconds(80)};
    page.status.declared_rate_hz = 50.00025;
    page.status.rate_advice = "change it";
    page.status.start_up_test = "HARD_ERR";
    page.status.more_counters["reconnects"] = 2;
    page.occupations.start("No.1", {"M. Ito", "windy"}, minute(50));
    const auto status = page.ask(get("/api/status"));
    CHECK(is(status, "/level", R"("warning")"));
    CHECK(is(status, "/reasons", R"(["disk nearly full"])"));
    CHECK(is(status, "/received", "1000"));
    CHECK(is(status, "/device/start_up_test", R"("HARD_ERR")"));
    CHECK(is(status, "/timing/state", R"("locked")"));
    CHECK(is(status, "/timing/uncertainty_ms", "1.5"));
    CHECK(is(status, "/timing/host_uncertainty_ms", "0.4"));
    CHECK(is(status, "/timing/clock_step/by_s", "-80.0"));
    CHECK(is(status, "/timing/rate/measured_hz", "50.0005"));
    CHECK(is(status, "/timing/rate/uncertainty_ppm", "0.03"));
    CHECK(is(status, "/timing/rate/span_h", "24.0"));
    CHECK(is(status, "/timing/rate/declared_hz", "50.00025"));
    CHECK(is(status, "/timing/rate/advice", R"("change it")"));
    CHECK(is(status, "/details/state", R"("stable")"));
    CHECK(is(status, "/details/reasons", "[]"));
    CHECK(status["sample"]["acceleration_mg"][0].get<double>() == Approx(1.5).epsilon(1e-15));
    CHECK(status["sample"]["acceleration_mg"][2].get<double>() == Approx(999.3).epsilon(1e-15));
    CHECK(is(status, "/sample/age_s", "0.5"));
    CHECK(is(status, "/sample/temperature_degc", "31.25"));
    CHECK(is(status, "/counters/checksum_errors", "2"));
    CHECK(is(status, "/counters/reconnects", "2"));
    CHECK(is(status, "/occupation/site", R"("No.1")"));
    CHECK(is(status, "/occupation/start", R"("2026-03-14T08:50:00.000Z")"));
    CHECK(is(status, "/occupation/running_s", "600.5"));
    CHECK(is(status, "/occupation/index", "3000"));
    CHECK(is(status, "/occupation/planned_s", "600.0"));
    CHECK(is(status, "/occupation/planned_set_ups", "1"));
    CHECK(is(status, "/occupation/has_own_plan", "false"));
    CHECK(is(status, "/occupation/set_up_left_s", "300.0"));
    CHECK(is(status, "/occupation/gravity", "null"));
    CHECK(is(status, "/occupation/whole/set_ups", "0"));
    CHECK(is(status, "/occupation/whole/set_up_sd_mgal", "null"));
    CHECK(is(status, "/occupation/whole/set_up_sd_limits_mgal", "null"));
    CHECK(is(status, "/occupation/session", '"' + page.recorder.session.to_hex() + '"'));
}

TEST_CASE("the verdict becomes no data when the last sample is older than the limit") {
    Page page;
    page.status.last_sample = minute(1);
    page.status.verdict.state = verdict::State::stable;
    page.status.now = minute(1) + config::kStaleAfter;
    CHECK(is(page.ask(get("/api/status")), "/details/state", R"("stable")"));
    page.status.now += Nanoseconds(1);
    const auto verdict = page.ask(get("/api/status"))["details"];
    CHECK(is(verdict, "/state", R"("no data")"));
    CHECK(is(verdict, "/reasons", R"(["last sample 3.0 s ago"])"));
}

TEST_CASE("texts that are not UTF-8 and numbers that are not finite do not break the status") {
    Page page;
    page.status.last_sample = page.status.now = minute(1);
    page.status.temperature = DegC(std::numeric_limits<double>::quiet_NaN());
    page.status.link_trouble = "read \xff\xfe";
    const auto status = page.ask(get("/api/status"));
    CHECK(is(status, "/sample/temperature_degc", "null"));
    CHECK(is(status, "/device/trouble", "\"read \xEF\xBF\xBD\xEF\xBF\xBD\""));
}
