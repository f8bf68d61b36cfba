#include <stdexcept>

#include "tests/unit/daemon/asked_page.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::page;
using namespace a351::daemon::status;

TEST_CASE("an occupation is started, set up again, renamed and stopped by POST", "[daemon][page]") {
    Page page;
    const auto started = page.ask(
        post("/api/occupation/start",
             R"({"site":"No.0","operator":"M. Ito","note":"windy","at":"2026-03-14T08:10:00Z"})"));
    CHECK(is(started, "/occupation/site", R"("No.0")"));
    CHECK(is(started, "/occupation/operator", R"("M. Ito")"));
    page.ask(post("/api/occupation/setup", R"({"at":"2026-03-14T17:20:00+09:00"})"));
    CHECK(page.occupations.running()->set_ups.back() == minute(20));
    CHECK(is(page.ask(get("/api/status")), "/occupation/key", R"("20260314T081000Z")"));
    const std::string key = R"("key":"20260314T081000Z")";
    page.ask(post("/api/occupation/rename", "{" + key + R"(,"site":"No.1"})"));
    page.ask(post("/api/note", R"({"note":"a lorry passed"})"));
    page.ask(post("/api/occupation/stop", R"({"site":"No.0"})"), 409);
    const auto stopped = page.ask(post("/api/occupation/stop", R"({"site":"","at":null})"));
    CHECK(is(stopped, "/occupation", "null"));
    const auto list = page.ask(get("/api/occupations"))["occupations"];
    REQUIRE(list.size() == 1);
    CHECK(is(list, "/0/site", R"("No.1")"));
    CHECK(list[0]["set_ups"].size() == 2);
    page.ask(post("/api/occupation/retime", "{" + key + R"(,"to":"2026-03-14T08:40:00Z"})"));
    page.ask(post("/api/note", "{" + key + R"(,"note":"calm"})"));
    page.ask(post("/api/occupation/discard", "{" + key + R"(,"site":"No.0"})"), 409);
    page.ask(post("/api/occupation/discard", "{" + key + R"(,"site":"No.1","reason":"wind"})"));
    const auto discarded = page.ask(get("/api/occupations"));
    CHECK(is(discarded, "/occupations", "[]"));
    CHECK(is(discarded, "/discarded/0/key", R"("20260314T081000Z")"));
    CHECK(is(discarded, "/discarded/0/note", R"("windy; a lorry passed; calm")"));
    page.ask(post("/api/occupation/restore", "{" + key + "}"));
    page.ask(post("/api/occupation/resume", "{" + key + "}"), 409);  // stopped 20 min ago
    CHECK(page.recorder.log.size() == 9);
}

TEST_CASE("a request that breaks a rule is answered 409 with the reason", "[daemon][page]") {
    Page page;
    const auto answer = page.ask(post("/api/occupation/start", R"({"site":"No.7"})"), 409);
    CHECK(answer["error"].get<std::string>().find("No.7") != std::string::npos);
    page.ask(post("/api/occupation/stop"), 409);
    page.ask(post("/api/note"), 409);
    CHECK(page.recorder.log.empty());
}

TEST_CASE("a change that cannot be written to disk is answered 500", "[daemon][page]") {
    Page page;
    page.recorder.is_disk_full = true;
    page.ask(post("/api/occupation/start", R"({"site":"No.0"})"), 500);
    CHECK(is(page.ask(get("/api/status")), "/occupation", "null"));
}

TEST_CASE("a malformed body is refused with an error that names the key", "[daemon][page]") {
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
    for (const char* change : {"discard", "restore", "resume", "rename", "retime", "not_moved"}) {
        const std::string path = std::string("/api/occupation/") + change;
        CHECK(trouble(path, R"({"site":"No.0"})").find("key key is missing") != std::string::npos);
        CHECK(trouble(path, R"({"key":"x","site":"No.0","at":"2026-03-14T08:10:00Z"})")
                  .find("key at") != std::string::npos);
    }
    for (const char* body : {"", "[]", "{}", R"({"target_mgal":5,"at":null})"})
        CHECK(trouble("/api/target", body) == "body: allowed: one key, target_mgal");
    CHECK(trouble("/api/target", R"({"target_mgal":"5"})") ==
          "body: key target_mgal: not a number");
    CHECK(page.recorder.log.empty());
}

TEST_CASE("a target is set by POST and refused outside the allowed range", "[daemon][page]") {
    Page page;
    page.ask(post("/api/target", R"({"target_mgal":0.5})"));
    REQUIRE(page.recorder.log.size() == 1);
    CHECK(page.recorder.log.back().type == "target");
    const auto refused = page.ask(post("/api/target", R"({"target_mgal":0.001})"), 409);
    CHECK_THAT(refused["error"].get<std::string>(), ContainsSubstring("0.01 to 1000 mGal"));
    CHECK(page.recorder.log.size() == 1);
}

TEST_CASE("GET changes nothing, POST reads nothing, and unknown paths are answered 404",
          "[daemon][page]") {
    Page page;
    const std::string changes[] = {
        "/api/occupation/start",   "/api/occupation/stop",    "/api/occupation/setup",
        "/api/occupation/discard", "/api/occupation/restore", "/api/occupation/resume",
        "/api/occupation/rename",  "/api/occupation/retime",  "/api/note"};
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

TEST_CASE("events are listed from a given time on, at most 1000 per answer", "[daemon][page]") {
    Page page;
    for (int i = 0; i < 1200; ++i) {
        events::Event event;
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

TEST_CASE("sites are listed with their reference gravity, or null if there is none",
          "[daemon][page]") {
    Page page;
    const auto list = page.ask(get("/api/sites"))["sites"];
    REQUIRE(list.size() == 2);
    CHECK(is(list, "/0/site", R"("No.0")"));
    CHECK(is(list, "/0/gravity_mgal", "979948.0"));
    CHECK(is(list, "/1/gravity_mgal", "null"));
}

TEST_CASE("sites are listed by their distance from the last occupation, nearest first",
          "[daemon][page]") {
    Page page;
    auto sites = two_sites();
    sites[0].latitude = Degrees(36.0);
    sites[1].latitude = Degrees(37.0);
    page.occupations.use(sites, {});
    CHECK(is(page.ask(get("/api/sites")), "/sites/0/site", R"("No.0")"));
    page.ask(post("/api/occupation/start", R"({"site":"No.1"})"));
    CHECK(is(page.ask(get("/api/sites")), "/sites/0/site", R"("No.1")"));
}

TEST_CASE("the token is given out only if the interface has one to give", "[daemon][page]") {
    Page page;
    CHECK(is(page.ask(get("/api/token")), "/token", '"' + kToken + '"'));
    Api exposed({.status = [] { return Status{}; },
                 .occupations = page.occupations,
                 .live = page.live,
                 .events = [] { return std::vector<events::Event>{}; }},
                "");
    CHECK(exposed.answer(get("/api/token")).status == 403);
}

TEST_CASE("an exception in a data source is answered 500 and counted", "[daemon][page]") {
    Page page;
    Api broken({.status = []() -> Status { throw std::runtime_error("no status"); },
                .occupations = page.occupations,
                .live = page.live,
                .events = []() -> std::vector<events::Event> { throw 1; }},
               "");
    CHECK(broken.answer(get("/api/status")).status == 500);
    CHECK(broken.use().failures == 1);
    CHECK(broken.answer(get("/api/events")).status == 500);
    CHECK(broken.use().failures == 2);
}
