#include <cstdlib>
#include <nlohmann/json.hpp>
#include "daemon/ctl/client.hpp"
#include "daemon/ctl/requests.hpp"
#include "daemon/ctl/screen.hpp"
#include "daemon/ctl/survey_text.hpp"
#include "daemon/ctl/when.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::daemon::ctl;

TEST_CASE("the status screen shows the rows of the daemon, coloured by their level") {
    const auto answer = nlohmann::json::parse(R"({"level":"warning","rows":[
        {"label":"state","text":"warning: disk nearly full","text_parts":["warning: disk nearly full"],"level":"warning"},
        {"label":"disk","text":"free 5.5 GB","text_parts":[["free",[]]," 5.5 GB"],"level":""}]})");
    CHECK(status_screen(answer, false) ==
          "state        warning: disk nearly full\ndisk         free 5.5 GB\n");
    CHECK(status_screen(answer, true) ==
          "state        \x1b[1;33mwarning: disk nearly full\x1b[0m\ndisk         free 5.5 GB\n");
    CHECK(plugin_status(answer) == 1);
    CHECK(plugin_status({{"level", 7}}) == 3);
}

TEST_CASE("a stay is one row with its gravity") {
    const auto set_up = [](const char* start, const char* end) {
        return nlohmann::json{{"start", start}, {"end", end}};
    };
    nlohmann::json stay = {{"site", "No.1"},
                           {"number", 1},
                           {"key", "K"},
                           {"set_ups", {set_up("a", "b"), set_up("b", "c")}},
                           {"gravity", {{"gravity_mgal", 980001.54}, {"u_mgal", 1.52}}}};
    CHECK(occupation_table({{"occupations", {stay}}}) ==
          "site  stay  start  end  gravity_mgal  u_mgal  key  operator  note\n"
          "No.1  1     a      c    980001.5      1.5     K    -         -\n");
    stay["site"] = "\u7b51\u6ce2";  // Two characters of two columns.
    CHECK(occupation_table({{"occupations", {stay}}})
              .ends_with("\u7b51\u6ce2  1     a      c    "
                         "980001.5      1.5     K    -         -\n"));
    stay["gravity"] = nullptr;
    CHECK(occupation_table({{"occupations", {stay}}}).find("a      c    -") != std::string::npos);
}

TEST_CASE("an answer without its members is of another program") {
    CHECK_THROWS_AS(answer_of({200, "{}"}), NoDaemon);
    CHECK_THROWS_AS(message_of({nlohmann::json{{"ok", true}}, ""}), NoDaemon);
    CHECK(message_of({nlohmann::json{{"message", "noted"}}, ""}) == "noted");
}

TEST_CASE("control characters in names do not reach the terminal") {
    CHECK(printable("No.0 \xC3\xA9") == "No.0 \xC3\xA9");
    CHECK(printable("\x1b[2J\x07\n\x7f") == "?[2J???");
    CHECK(printable("\xC2\x9B"
                    "2J") == "?2J");
    const nlohmann::json hostile = {{"rows", {{{"label", "site"}, {"text", "\x1b]0;x\x07"}}}}};
    CHECK(status_screen(hostile, false).find('\x1b') == std::string::npos);
}

TEST_CASE("the URL of a daemon is http, a host and an optional port") {
    CHECK(parse_url("http://127.0.0.1:8351").authority() == "127.0.0.1:8351");
    CHECK(parse_url("http://[::1]:8351/").authority() == "[::1]:8351");
    CHECK(parse_url("http://gravbox").authority() == "gravbox:80");
    for (const char* odd : {"", "127.0.0.1:8351", "https://x", "http://", "http://:8351",
                            "http://x:", "http://x:port", "http://x/y", "http://[::1", "http://a b",
                            "http://u@x", "http://x:8351:1"}) {
        CAPTURE(odd);
        CHECK_THROWS_AS(parse_url(odd), InputError);
    }
}

TEST_CASE("an instant is read as RFC 3339, as a local time or as a time ago") {
    const char* const zone = std::getenv("TZ");
    const std::string before = zone == nullptr ? "" : zone;
    setenv("TZ", "JST-9", 1);
    tzset();
    const UtcTime now = *parse_rfc3339("2026-03-14T00:30:00Z");  // 09:30 in Japan
    const auto read = [&](const char* text) {
        const auto instant = parse_when(text, now);
        return instant ? to_rfc3339(*instant) : "none";
    };
    CHECK(read("2026-03-14T08:10:00+09:00") == "2026-03-13T23:10:00Z");
    CHECK(read("00:05Z") == "2026-03-14T00:05:00Z");
    CHECK(read("23:45:10Z") == "2026-03-13T23:45:10Z");
    CHECK(read("08:45") == "2026-03-13T23:45:00Z");
    CHECK(read("09:30:00") == "2026-03-14T00:30:00Z");
    CHECK(read("10:30") == "2026-03-14T01:30:00Z");  // a fast watch: the daemon refuses it
    CHECK(read("10:31") == "2026-03-13T01:31:00Z");  // of the day before
    CHECK(read("23:59") == "2026-03-13T14:59:00Z");
    CHECK(read("-12min") == "2026-03-14T00:18:00Z");
    CHECK(read("-30s") == "2026-03-14T00:29:30Z");
    CHECK(read("-1.5h") == "2026-03-13T23:00:00Z");
    for (const char* wrong : {"", "8:45", "24:00", "08:60", "08:45:60", "08-45", "08:45:", "-12",
                              "12min", "--2min", "-min", "-1e9h", "-nanmin", "noon"}) {
        CAPTURE(wrong);
        CHECK(read(wrong) == "none");
    }
    // The hour from 02:00 to 03:00 occurs twice on the last Sunday of October; after wfrog #120 and
    // DOI-USGS/dataRetrieval #121.
    setenv("TZ", "CET-1CEST,M3.5.0,M10.5.0/3", 1);
    tzset();
    const auto at = [](const char* utc, const char* text) {
        return to_rfc3339(*parse_when(text, *parse_rfc3339(utc)));
    };
    CHECK(at("2024-10-27T00:29:00Z", "02:25") == "2024-10-27T00:25:00Z");
    CHECK(at("2024-10-27T01:20:00Z", "02:25") == "2024-10-27T00:25:00Z");
    CHECK(at("2024-10-27T01:29:00Z", "02:25") == "2024-10-27T01:25:00Z");
    CHECK(at("2024-10-27T09:00:00Z", "02:25") == "2024-10-27T01:25:00Z");
    CHECK(at("2024-10-27T23:30:00Z", "02:25") == "2024-10-27T01:25:00Z");  // the day before
    CHECK(at("2024-10-27T09:00:00Z", "03:10") == "2024-10-27T02:10:00Z");
    CHECK(at("2024-03-31T09:00:00Z", "01:59") == "2024-03-31T00:59:00Z");
    setenv("TZ", "LHST-10:30LHDT-11,M10.1.0,M4.1.0", 1);  // half an hour, in the south
    tzset();
    CHECK(at("2024-04-06T14:50:00Z", "01:40") == "2024-04-06T14:40:00Z");
    CHECK(at("2024-04-06T15:20:00Z", "01:40") == "2024-04-06T15:10:00Z");
    setenv("TZ", before.c_str(), 1);
    if (before.empty()) unsetenv("TZ");
    tzset();
}

TEST_CASE("the gravity so far is a table with findings first and remarks behind") {
    const auto answer = nlohmann::json::parse(R"({
        "as_of_utc": "2026-03-01T12:03:10.000Z", "data_to_utc": "2026-03-01T12:03:09.500Z",
        "reason": "killed", "reason_text": "signal 9 ended it", "model": "day",
        "stays": [
            {"site": "No.0", "occupation": 1, "set_ups": 1, "gravity_mgal": 979861.324,
             "u_mgal": 1.266, "left_out_difference_mgal": -0.42,
             "is_running": false, "remarks": []},
            {"site": "No.5\u001b", "occupation": 12, "set_ups": 2, "gravity_mgal": null,
             "u_mgal": null, "left_out_difference_mgal": null, "missing_parts": ["read on"],
             "is_running": true,
             "remarks": [{"code": "left_out", "numbers": [], "text": "no samples"}]}],
        "findings": [{"text": "the box moved", "is_headline": true}]})");
    CHECK(survey_text(answer) ==
          "! the box moved\n"
          "stay        gravity_mgal  u_mgal  left_out_difference_mgal  set_ups\n"
          "No.0 (1)       979861.32    1.27                     -0.42        1\n"
          "No.5? (12)             -       -                         -        2\n"
          "  No.5? (12): running\n"
          "  No.5? (12): read on\n"
          "  No.5? (12): no samples\n"
          "no new figures: killed: signal 9 ended it\n"
          "as of 2026-03-01T12:03:10.000Z, data up to 2026-03-01T12:03:09.500Z, model day\n");
    const auto before_the_first_stay = nlohmann::json::parse(R"({
        "as_of_utc": "2026-03-01T12:03:10.000Z", "data_to_utc": null, "reason": "no_stay",
        "reason_text": "no stay was started", "reason_parts": [["no stay was started", []]],
        "model": null, "stays": [], "findings": []})");
    CHECK(survey_text(before_the_first_stay) ==
          "no new figures: no stay was started\nas of 2026-03-01T12:03:10.000Z, without data\n");
}
