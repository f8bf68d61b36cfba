#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "daemon/page/api.hpp"
#include "daemon/page/guard.hpp"
#include "protocol/core/input_error.hpp"
#include "tests/unit/daemon/fake_recorder.hpp"

using namespace a351;
using namespace a351::daemon;
using nlohmann::json;

namespace {

const std::string kToken = "0123456789abcdef0123456789abcdef";

Request get(const std::string& target) { return {"GET", target, {{"Host", "127.0.0.1:8351"}}, ""}; }

Request post(const std::string& target, const std::string& body = "{}") {
    return {"POST",
            target,
            {{"Host", "127.0.0.1:8351"},
             {"Content-Type", "application/json"},
             {"X-A351-Token", kToken}},
            body};
}

Request with(Request request, const std::string& name, const std::string& value) {
    std::erase_if(request.headers, [&](const auto& header) { return header.first == name; });
    request.headers.emplace_back(name, value);
    return request;
}

Request without(Request request, const std::string& name) {
    std::erase_if(request.headers, [&](const auto& header) { return header.first == name; });
    return request;
}

int refused_with(const Guard& guard, const Request& request) {
    const auto response = guard.refuse(request);
    return response ? response->status : 200;
}

/// Whether the member at `pointer` is written as `expected`.  Not json's own comparison, each use
/// of which within CHECK costs the compiler a second.
bool is(const json& whole, const std::string& pointer, const std::string& expected) {
    const auto found = whole.at(json::json_pointer(pointer)).dump();
    UNSCOPED_INFO(pointer << " is " << found << ", not " << expected);
    return found == expected;
}

/// An interface over a recorder that remembers an hour.
struct Page {
    FakeRecorder recorder;
    Occupations occupations{recorder, two_sites(), {}};
    LiveRecord live{*wire::find_profile("A351"), 50, {}};
    Status status;
    Api api{{.status = [this] { return status; },
             .occupations = occupations,
             .live = live,
             .events = [this] { return recorder.log; }},
            kToken};

    json ask(const Request& request, int expected = 200) {
        const auto response = api.answer(request);
        CAPTURE(request.target, request.body, response.body);
        CHECK(response.status == expected);
        auto body = json::parse(response.body);
        CHECK(body.contains("error") == (expected != 200));
        return body;
    }
};

}  // namespace

TEST_CASE("a Host outside the list is misdirected", "[daemon][page]") {
    const Guard guard(8351, {"Gravbox", "field.example:80"}, kToken);
    for (const char* host : {"127.0.0.1:8351", "localhost:8351", "LocalHost:8351", "[::1]:8351",
                             "gravbox:8351", "GRAVBOX:8351", "field.example:80"}) {
        CHECK(refused_with(guard, with(get("/"), "Host", host)) == 200);
    }
    for (const char* host :
         {"evil.example:8351", "127.0.0.1", "127.0.0.1:80", "localhost", "localhost:83511", "",
          "field.example", "gravbox", "127.0.0.1:8351.evil.example", "localhost:8351 "}) {
        CHECK(refused_with(guard, with(get("/"), "Host", host)) == 421);
        CHECK(refused_with(guard, with(post("/api/note"), "Host", host)) == 421);
    }
    CHECK(refused_with(guard, without(get("/"), "Host")) == 421);
    auto two = get("/");
    two.headers.emplace_back("host", "127.0.0.1:8351");
    CHECK(refused_with(guard, two) == 421);
}

TEST_CASE("under rebinding Host and Origin agree and are refused all the same", "[daemon][page]") {
    const Guard guard(8351, {}, kToken);
    auto request = with(post("/api/note"), "Host", "evil.example:8351");
    request = with(request, "Origin", "http://evil.example:8351");
    CHECK(refused_with(guard, request) == 421);
}

TEST_CASE("a change from a foreign Origin is forbidden", "[daemon][page]") {
    const Guard guard(8351, {"gravbox"}, kToken);
    for (const char* origin : {"http://127.0.0.1:8351", "http://localhost:8351",
                               "http://[::1]:8351", "http://gravbox:8351"}) {
        CHECK(refused_with(guard, with(post("/api/note"), "Origin", origin)) == 200);
    }
    for (const char* origin : {"http://evil.example", "null", "", "https://127.0.0.1:8351",
                               "http://127.0.0.1:80", "127.0.0.1:8351"}) {
        CHECK(refused_with(guard, with(post("/api/note"), "Origin", origin)) == 403);
    }
}

TEST_CASE("a change needs the token, also without Origin", "[daemon][page]") {
    const Guard guard(8351, {}, kToken);
    CHECK(refused_with(guard, post("/api/note")) == 200);
    CHECK(refused_with(guard, without(post("/api/note"), "X-A351-Token")) == 403);
    for (const std::string& token : {std::string(), kToken + "0", kToken.substr(1), "x" + kToken,
                                     std::string(kToken.size(), 'x')}) {
        CHECK(refused_with(guard, with(post("/api/note"), "X-A351-Token", token)) == 403);
    }
    const auto page = with(post("/api/note"), "Origin", "http://127.0.0.1:8351");
    CHECK(refused_with(guard, without(page, "X-A351-Token")) == 403);
    auto delete_request = without(post("/api/note"), "X-A351-Token");
    delete_request.method = "DELETE";
    CHECK(refused_with(guard, delete_request) == 403);
}

TEST_CASE("an empty token opens nothing", "[daemon][page]") {
    const Guard guard(8351, {}, "");
    CHECK(refused_with(guard, with(post("/api/note"), "X-A351-Token", "")) == 403);
}

TEST_CASE("a change is application/json, for a form can be sent across sites", "[daemon][page]") {
    const Guard guard(8351, {}, kToken);
    for (const char* type : {"application/json", "application/json; charset=utf-8",
                             "Application/JSON ;charset=utf-8"}) {
        CHECK(refused_with(guard, with(post("/api/note"), "Content-Type", type)) == 200);
    }
    for (const char* type : {"text/plain", "application/x-www-form-urlencoded", "", ";",
                             "application/json5", "text/plain; application/json"}) {
        CHECK(refused_with(guard, with(post("/api/note"), "Content-Type", type)) == 403);
    }
    CHECK(refused_with(guard, without(post("/api/note"), "Content-Type")) == 403);
}

TEST_CASE("random tokens have 256 bits and differ", "[daemon][page]") {
    const auto token = random_token();
    CHECK(token.size() == 64);
    CHECK(token.find_first_not_of("0123456789abcdef") == std::string::npos);
    CHECK(random_token() != token);
}

TEST_CASE("no header opens the interface to other origins", "[daemon][page]") {
    std::set<std::string> names;
    for (const auto& [name, value] : security_headers()) {
        CHECK_FALSE(name.starts_with("Access-Control"));
        CHECK(value.find("unsafe") == std::string::npos);
        names.insert(name);
    }
    for (const char* name : {"Content-Security-Policy", "X-Frame-Options", "X-Content-Type-Options",
                             "Cross-Origin-Resource-Policy", "Cache-Control"}) {
        CHECK(names.contains(name));
    }
}

TEST_CASE("every fixed field of the status is there before the first sample", "[daemon][page]") {
    Page page;
    const auto status = page.ask(get("/api/status"));
    for (const char* field : {"/api",
                              "/version",
                              "/level",
                              "/session",
                              "/received",
                              "/journaled",
                              "/archived",
                              "/timing/state",
                              "/timing/uncertainty_ms",
                              "/verdict/state",
                              "/verdict/reasons",
                              "/occupation",
                              "/counters/gaps",
                              "/counters/checksum_errors",
                              "/counters/bytes_skipped",
                              "/counters/duplicates",
                              "/oven",
                              "/device/port",
                              "/disk/free_bytes",
                              "/disk/reserve",
                              "/disk/longest_sync_ms"}) {
        CAPTURE(field);
        CHECK(status.contains(json::json_pointer(field)));
    }
    CHECK(is(status, "/level", R"("good")"));
    CHECK(is(status, "/session", "null"));
    CHECK(is(status, "/received", "null"));
    CHECK(is(status, "/occupation", "null"));
    CHECK(is(status, "/sample", "null"));
    CHECK(is(status, "/timing/state", R"("unlocked")"));
    CHECK(is(status, "/verdict/state", R"("no data")"));
    CHECK(status["verdict"]["reasons"].size() == 1);
}

TEST_CASE("the status tells of the oven with units, and of a doubtful temperature nothing",
          "[daemon][page]") {
    Page page;
    CHECK(page.ask(get("/api/status"))["oven"] == json{{"state", "disabled"}});
    page.status.oven =
        OvenStatus{.state = "answering",
                   .trouble = "",
                   .port = "/dev/pts/5",
                   .values = oven::ControllerValues{DegC(42.5), DegC(43.0), Percent(25.0), 0x0100},
                   .decimals = 1,
                   .age = std::chrono::milliseconds(1500),
                   .is_stale = false,
                   .polls = {{"answered", 7}, {"bad_crc", 2}}};
    CHECK(page.ask(get("/api/status"))["oven"] ==
          json{{"state", "answering"},
               {"trouble", ""},
               {"port", "/dev/pts/5"},
               {"process_value_degc", 42.5},
               {"set_point_degc", 43.0},
               {"heating_percent", 25.0},
               {"status_word", 256},
               {"has_input_error", false},
               {"decimals", 1},
               {"age_s", 1.5},
               {"is_stale", false},
               {"polls", {{"answered", 7}, {"bad_crc", 2}}}});
    page.status.oven->values->process_value.reset();
    page.status.oven->values->status = oven::kInputError;
    const auto doubtful = page.ask(get("/api/status"));
    CHECK(is(doubtful, "/oven/process_value_degc", "null"));
    CHECK(is(doubtful, "/oven/has_input_error", "true"));
    page.status.oven->values.reset();
    page.status.oven->age.reset();
    const auto silent = page.ask(get("/api/status"));
    for (const char* field : {"process_value_degc", "set_point_degc", "heating_percent",
                              "status_word", "has_input_error", "age_s"}) {
        CHECK(silent["oven"].at(field).is_null());
    }
}

TEST_CASE("the status carries values with their units", "[daemon][page]") {
    Page page;
    page.status.level = Status::Level::warning;
    page.status.verdict.state = VerdictState::stable;
    page.status.reasons = {"disk nearly full"};
    page.status.now = minute(60) + std::chrono::milliseconds(500);
    page.status.last_sample = minute(60);
    page.status.received = 179'999;
    page.status.journaled = 179'990;
    page.status.timing_state = timing::TimingState::locked;
    page.status.timing_uncertainty = std::chrono::microseconds(1500);
    page.status.measured_rate = {Hertz(50.0005), 0.03, std::chrono::hours(24)};
    page.status.declared_rate_hz = 50.00025;
    page.status.rate_advice = "change it";
    page.status.acceleration = {StandardGravity(0.001), StandardGravity(-0.002),
                                StandardGravity(0.9993)};
    page.status.temperature = DegC(31.25);
    page.status.counters.gaps = 3;
    page.status.more_counters["reconnects"] = 2;
    page.occupations.start("No.1", {"M. Ito", "windy"}, minute(50));
    const auto status = page.ask(get("/api/status"));
    CHECK(is(status, "/level", R"("warning")"));
    CHECK(is(status, "/reasons", R"(["disk nearly full"])"));
    CHECK(is(status, "/received", "179999"));
    CHECK(is(status, "/timing/state", R"("locked")"));
    CHECK(is(status, "/timing/uncertainty_ms", "1.5"));
    CHECK(is(status, "/timing/rate/measured_hz", "50.0005"));
    CHECK(is(status, "/timing/rate/uncertainty_ppm", "0.03"));
    CHECK(is(status, "/timing/rate/span_h", "24.0"));
    CHECK(is(status, "/timing/rate/declared_hz", "50.00025"));
    CHECK(is(status, "/timing/rate/advice", R"("change it")"));
    CHECK(is(status, "/verdict/state", R"("stable")"));
    CHECK(is(status, "/verdict/reasons", "[]"));
    CHECK(status["sample"]["acceleration_mg"][0].get<double>() == Approx(1.0).epsilon(1e-15));
    CHECK(status["sample"]["acceleration_mg"][2].get<double>() == Approx(999.3).epsilon(1e-15));
    CHECK(is(status, "/sample/age_s", "0.5"));
    CHECK(is(status, "/sample/temperature_degc", "31.25"));
    CHECK(is(status, "/counters/gaps", "3"));
    CHECK(is(status, "/counters/reconnects", "2"));
    CHECK(is(status, "/occupation/site", R"("No.1")"));
    CHECK(is(status, "/occupation/start", R"("2026-03-14T08:50:00.000Z")"));
    CHECK(is(status, "/occupation/running_s", "600.5"));
    CHECK(is(status, "/occupation/index", "3000"));
    CHECK(is(status, "/occupation/session", '"' + page.recorder.session.to_hex() + '"'));
}

TEST_CASE("the verdict is no data from 3 s without a sample on", "[daemon][page]") {
    Page page;
    page.status.last_sample = minute(1);
    page.status.verdict.state = VerdictState::stable;
    page.status.now = minute(1) + std::chrono::seconds(3);
    CHECK(is(page.ask(get("/api/status")), "/verdict/state", R"("stable")"));
    page.status.now += Nanoseconds(1);
    const auto verdict = page.ask(get("/api/status"))["verdict"];
    CHECK(is(verdict, "/state", R"("no data")"));
    CHECK(is(verdict, "/reasons", R"(["last sample 3.0 s ago"])"));
}

TEST_CASE("texts that are not UTF-8 and numbers that are not finite do not break the status",
          "[daemon][page]") {
    Page page;
    page.status.last_sample = page.status.now = minute(1);
    page.status.temperature = DegC(std::numeric_limits<double>::quiet_NaN());
    page.status.link_trouble = "read \xff\xfe";
    const auto status = page.ask(get("/api/status"));
    CHECK(is(status, "/sample/temperature_degc", "null"));
    CHECK(is(status, "/device/trouble", "\"read \xEF\xBF\xBD\xEF\xBF\xBD\""));
}

TEST_CASE("an occupation is started, set up anew, renamed and stopped by POST", "[daemon][page]") {
    Page page;
    const auto started = page.ask(
        post("/api/occupation/start",
             R"({"site":"No.0","operator":"M. Ito","note":"windy","at":"2026-03-14T08:10:00Z"})"));
    CHECK(is(started, "/occupation/site", R"("No.0")"));
    CHECK(is(started, "/occupation/operator", R"("M. Ito")"));
    page.ask(post("/api/occupation/setup", R"({"at":"2026-03-14T17:20:00+09:00"})"));
    CHECK(page.occupations.running()->set_ups.back() == minute(20));
    page.ask(post("/api/occupation/rename", R"({"site":"No.1"})"));
    page.ask(post("/api/note", R"({"note":"a lorry passed"})"));
    page.ask(post("/api/occupation/stop", R"({"site":"No.0"})"), 409);
    const auto stopped = page.ask(post("/api/occupation/stop", R"({"site":"","at":null})"));
    CHECK(is(stopped, "/occupation", "null"));
    const auto list = page.ask(get("/api/occupations"))["occupations"];
    REQUIRE(list.size() == 1);
    CHECK(is(list, "/0/site", R"("No.1")"));
    CHECK(list[0]["set_ups"].size() == 2);
    page.ask(post("/api/occupation/discard"));
    CHECK(is(page.ask(get("/api/occupations")), "/occupations", "[]"));
    CHECK(page.recorder.log.size() == 6);
}

TEST_CASE("a request against a rule is a conflict and says why", "[daemon][page]") {
    Page page;
    const auto answer = page.ask(post("/api/occupation/start", R"({"site":"No.7"})"), 409);
    CHECK(answer["error"].get<std::string>().find("No.7") != std::string::npos);
    page.ask(post("/api/occupation/stop"), 409);
    page.ask(post("/api/note"), 409);
    CHECK(page.recorder.log.empty());
}

TEST_CASE("a change that cannot be written is a server error", "[daemon][page]") {
    Page page;
    page.recorder.is_disk_full = true;
    page.ask(post("/api/occupation/start", R"({"site":"No.0"})"), 500);
    CHECK(is(page.ask(get("/api/status")), "/occupation", "null"));
}

TEST_CASE("malformed bodies are refused by the key", "[daemon][page]") {
    Page page;
    const auto trouble = [&](const std::string& path, const std::string& body) {
        return page.ask(post(path, body), 400)["error"].get<std::string>();
    };
    const std::string start = "/api/occupation/start";
    for (const char* body : {"", "{", "[]", "null", "\"No.0\"", "{\"site\":\"\xff\"}", "{} {}"}) {
        CHECK(trouble(start, body) == "body: not a JSON object");
    }
    CHECK(trouble(start, std::string(16'000, '[')) == "body: not a JSON object");
    CHECK(trouble(start, "{}").find("site is missing") != std::string::npos);
    CHECK(trouble(start, R"({"site":1})").find("key site") != std::string::npos);
    CHECK(trouble(start, R"({"site":"No.0","At":""})").find("key At is unknown") !=
          std::string::npos);
    CHECK(trouble(start, R"({"site":"No.0","at":"noon"})").find("at = noon") != std::string::npos);
    CHECK(trouble("/api/occupation/discard", R"({"site":"No.0"})").find("none") !=
          std::string::npos);
    CHECK(trouble("/api/occupation/rename", R"({"site":"No.0","at":"2026-03-14T08:10:00Z"})")
              .find("key at") != std::string::npos);
    CHECK(page.recorder.log.empty());
}

TEST_CASE("GET changes nothing and unknown paths are not found", "[daemon][page]") {
    Page page;
    const std::string changes[] = {"/api/occupation/start",  "/api/occupation/stop",
                                   "/api/occupation/setup",  "/api/occupation/discard",
                                   "/api/occupation/rename", "/api/note"};
    for (const auto& path : changes) {
        const auto response = page.api.answer(get(path));
        CHECK(response.status == 405);
        CHECK(response.headers.front().first == "Allow");
        CHECK(response.headers.front().second == "POST");
    }
    for (const char* path : {"/api/status", "/api/events", "/api/sites", "/api/token", "/"}) {
        const auto response = page.api.answer(post(path));
        CHECK(response.status == 405);
        CHECK(response.headers.front().first == "Allow");
    }
    for (const char* path : {"/api", "/api/status/", "/../etc/passwd", "", "*", "//api/status",
                             "http://127.0.0.1:8351/api/status", "/api/occupation"}) {
        CHECK(page.api.answer(get(path)).status == 404);
        CHECK(page.api.answer(post(path)).status == 404);
    }
    CHECK(page.recorder.log.empty());
}

TEST_CASE("events are told from an instant on, at most a thousand at a time", "[daemon][page]") {
    Page page;
    for (int i = 0; i < 1200; ++i) {
        record::Event event;
        event.type = "note";
        event.utc = kMorning + std::chrono::seconds(i);
        page.recorder.log.push_back(event);
    }
    const auto newest = page.ask(get("/api/events"));
    CHECK(newest["events"].size() == 1000);
    CHECK(is(newest, "/complete", "false"));
    CHECK(is(newest, "/events/999/type", R"("note")"));
    const auto late = page.ask(get("/api/events?since=2026-03-14T08%3A19%3A50Z"));
    CHECK(late["events"].size() == 10);
    CHECK(is(late, "/complete", "true"));
    const auto early = page.ask(get("/api/events?since=2026-03-14T08:00:01Z"));
    CHECK(early["events"].size() == 1000);
    CHECK(is(early, "/complete", "false"));
    for (const char* query : {"?since=", "?since=noon", "?until=2026-03-14T08:00:01Z", "?since=%4",
                              "?since=%zz", "?since=2026-03-14T08:00:01Z&x=1"}) {
        page.ask(get(std::string("/api/events") + query), 400);
    }
}

TEST_CASE("sites are told with their reference or without", "[daemon][page]") {
    Page page;
    const auto list = page.ask(get("/api/sites"))["sites"];
    REQUIRE(list.size() == 2);
    CHECK(is(list, "/0/site", R"("No.0")"));
    CHECK(is(list, "/0/gravity_mgal", "979948.0"));
    CHECK(is(list, "/1/gravity_mgal", "null"));
}

TEST_CASE("the token is handed out only when the interface may", "[daemon][page]") {
    Page page;
    CHECK(is(page.ask(get("/api/token")), "/token", '"' + kToken + '"'));
    Api exposed({.status = [] { return Status{}; },
                 .occupations = page.occupations,
                 .live = page.live,
                 .events = [] { return std::vector<record::Event>{}; }},
                "");
    CHECK(exposed.answer(get("/api/token")).status == 403);
}

TEST_CASE("an exception of a source is a server error and is counted", "[daemon][page]") {
    Page page;
    Api broken({.status = []() -> Status { throw std::runtime_error("no status"); },
                .occupations = page.occupations,
                .live = page.live,
                .events = []() -> std::vector<record::Event> { throw 1; }},
               "");
    CHECK(broken.answer(get("/api/status")).status == 500);
    CHECK(broken.use().failures == 1);
    CHECK(broken.answer(get("/api/events")).status == 500);
    CHECK(broken.use().failures == 2);
}
