#include <stdexcept>

#include "tests/support/temporary_directory.hpp"
#include "tests/unit/daemon/asked_page.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::page;
using namespace a351::daemon::status;

TEST_CASE("an occupation is started, set up again, renamed and stopped by POST") {
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

TEST_CASE("no stay and no set-up begins while no samples come") {
    Page page;
    page.status.last_sample = minute(60);
    page.status.now = minute(60) + 5 * config::kStaleAfter;
    CHECK(is(
        page.ask(post("/api/occupation/start", R"({"site":"No.0"})"), 409), "/error",
        R"("no samples have come since 2026-03-14T09:00:00Z, so nothing can begin now: check the sensor's plug")"));
    const std::string earlier = R"({"site":"No.0","at":"2026-03-14T08:40:00Z"})";
    page.ask(post("/api/occupation/start", earlier));
    page.ask(post("/api/occupation/setup", "{}"), 409);
    page.ask(post("/api/occupation/stop", "{}"));
    const std::string key = R"({"key":"20260314T084000Z"})";
    page.ask(post("/api/occupation/resume", key), 409);
    page.status.link_state = "sampling";  // The host's clock was set.
    page.ask(post("/api/occupation/resume", key));
}

TEST_CASE("the plan and the face that were entered at a start are in the log") {
    Page page;
    const auto start = [&](const std::string& more, int expected) {
        return page.ask(post("/api/occupation/start",
                             R"({"site":"No.0","at":"2026-03-14T08:10:00Z",)" + more + "}"),
                        expected);
    };
    CHECK(start(R"("set_ups":"20abc")", 400)["error"] ==
          "body: key set_ups = 20abc: not a whole number; allowed: 2 to 100");
    CHECK(start(R"("face":"up")", 400)["error"] ==
          "body: key face = up: not a face; allowed: + or -");
    start(R"("set_ups":"101")", 409);
    start(R"("set_ups":"20","face":"-")", 200);
    REQUIRE(page.recorder.log.size() == 1);
    CHECK(page.recorder.log[0].details.at("set_ups") == "20");
    CHECK(page.recorder.log[0].details.at("face") == "-");
    const auto status = page.ask(get("/api/status"));
    CHECK(is(status, "/occupation/planned_set_ups", "20"));
    CHECK(is(status, "/occupation/has_own_plan", "true"));
    CHECK(is(status, "/occupation/planned_s", "3600.0"));
}

TEST_CASE(
    "a request that breaks a rule is answered 409, a full disk 500, and only changes are counted") {
    Page page;
    const auto changes = [&] { return page.ask(get("/api/status"))["changes"].get<int>(); };
    const std::string start = R"({"site":"No.0","at":"2026-03-14T08:10:00Z"})";
    CHECK(is(page.ask(get("/api/survey")), "/reason", R"("not_yet")"));
    page.ask(post("/api/survey"), 405);
    page.ask(get("/api/occupations"));
    const auto unknown = page.ask(post("/api/occupation/start", R"({"site":"No.7"})"), 409);
    CHECK_THAT(unknown["error"].get<std::string>(), ContainsSubstring("No.7"));
    page.ask(post("/api/occupation/stop"), 409);
    page.ask(post("/api/note"), 409);
    page.recorder.is_disk_full = true;
    page.ask(post("/api/occupation/start", start), 500);
    CHECK(is(page.ask(get("/api/status")), "/occupation", "null"));
    CHECK(page.recorder.log.empty());
    CHECK(page.changes == 0);
    CHECK(changes() == 0);

    page.recorder.is_disk_full = false;
    const auto before = page.api.urgent_status();
    page.ask(post("/api/occupation/start", start));
    CHECK(page.changes == 1);
    CHECK(page.api.urgent_status() != before);
    page.ask(post("/api/occupation/start", R"({"site":"No.0"})"), 409);
    page.recorder.is_disk_full = true;
    page.ask(post("/api/occupation/stop"), 500);
    CHECK(page.changes == 1);
    CHECK(changes() == 1);
    page.recorder.is_disk_full = false;
    page.ask(post("/api/note", R"({"note":"windy"})"));
    page.occupations.use(two_sites(), {});
    CHECK(changes() == 3);
}

TEST_CASE("a malformed body is refused with an error that names the key") {
    Page page;
    const auto trouble = [&](const std::string& path, const std::string& body) {
        return page.ask(post(path, body), 400)["error"].get<std::string>();
    };
    const std::string start = "/api/occupation/start";
    for (const char* body : {"", "{", "[]", "null", "\"No.0\"", "{\"site\":\"\xff\"}", "{} {}"})
        CHECK(trouble(start, body) == "body: not a JSON object");
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
    CHECK(page.recorder.log.empty());
}

TEST_CASE("a stop or a set-up that names another stay than the running one is refused") {
    Page page;
    page.ask(post("/api/occupation/start", R"({"site":"No.0","at":"2026-03-14T08:10:00Z"})"));
    for (const char* change : {"stop", "setup"}) {
        const std::string path = std::string("/api/occupation/") + change;
        const auto answer = page.ask(post(path, R"({"key":"20260314T080000Z"})"), 409);
        CHECK(is(answer, "/error",
                 R"("No.0 (stay 1) is running, not 20260314T080000Z; nothing was changed")"));
        page.ask(post(path, R"({"key":"20260314T081000Z","site":"No.1"})"), 409);
    }
    CHECK(page.recorder.log.size() == 1);
    const std::string right = R"({"key":"20260314T081000Z","site":"No.0",)";
    page.ask(post("/api/occupation/setup", right + R"("at":"2026-03-14T08:20:00Z"})"));
    page.ask(post("/api/occupation/stop", right + R"("at":"2026-03-14T08:30:00Z"})"));
    page.ask(post("/api/occupation/stop", R"({"key":"20260314T081000Z"})"), 409);
    CHECK(page.recorder.log.size() == 3);
}

TEST_CASE(
    "a stay that has ended gets a missed set-up by resume, setup and stop, as the page orders it") {
    Page page;
    page.recorder.last = minute(30);
    page.ask(post("/api/occupation/start", R"({"site":"No.0","at":"2026-03-14T08:10:00Z"})"));
    page.ask(post("/api/occupation/stop", R"({"at":"2026-03-14T08:25:00Z"})"));
    const auto before = page.ask(get("/api/occupations"))["occupations"][0]["set_ups"];
    const std::string stay = R"({"key":"20260314T081000Z","site":"No.0")";
    page.ask(post("/api/occupation/resume", stay + "}"));
    page.ask(post("/api/occupation/setup", stay + R"(,"at":"2026-03-14T08:17:20.000Z"})"));
    page.ask(post("/api/occupation/stop", stay + R"(,"at":)" + before[0]["end"].dump() + "}"));
    const auto after = page.ask(get("/api/occupations"))["occupations"][0]["set_ups"];
    REQUIRE(after.size() == 2);
    CHECK(is(after, "/0/end", R"("2026-03-14T08:17:20.000Z")"));
    CHECK(is(after, "/1/end", before[0]["end"].dump()));
}

namespace {

/// A page at minute 30, whose sensor is stable and whose stay at No.0 runs since minute 10.
struct StayPage : Page {
    StayPage() {
        status.now = status.last_sample.emplace(minute(30));
        status.verdict.state = verdict::State::stable;
        ask(post("/api/occupation/start", R"({"site":"No.0","at":"2026-03-14T08:10:00Z"})"));
    }
    void stop() { ask(post("/api/occupation/stop", R"({"at":"2026-03-14T08:20:00Z"})")); }
    /// Gives the gravity so far one contradiction of the running stay.
    void contradict(const std::string& member, const std::string& code) {
        gravity_so_far =
            R"({"data_to_utc":"2026-03-14T08:29:00.000Z","lesser_contradictions":[],")" + member +
            R"(":[{"code":")" + code +
            R"(","key":"20260314T081000Z","text":"No.1 is 71.0 mGal off"}]})";
    }
    json signal() { return ask(get("/api/status"))["signal"]; }
    std::string word() { return signal()["word"]; }
    std::string level() { return ask(get("/api/status"))["level"]; }
};

}  // namespace

TEST_CASE_METHOD(StayPage, "what was looked at is not shown again, also after a restart") {
    stop();
    gravity_so_far = R"({"contradictions":[{"code":"reference","key":"20260314T081000Z",)"
                     R"("text":"No.1 is 71.0 mGal off"}]})";
    // One of another day is not to be cleared up now.
    const std::string of_today = gravity_so_far;
    gravity_so_far.replace(gravity_so_far.rfind("20260314"), 8, "20260313");
    CHECK(word() == "go");
    gravity_so_far = of_today;
    CHECK(word() == "look");
    CHECK(is(signal(), "/sentence", R"("No.1 is 71.0 mGal off")"));
    CHECK(is(signal(), "/buttons", R"(["checked"])"));
    CHECK(is(ask(get("/api/rows")), "/rows/2/text",
             R"("a351ctl rename 20260314T081000Z SITE, or a351ctl checked")"));
    CHECK(level() == "warning");
    ask(post("/api/occupation/checked", R"({"code":"another","key":"20260314T081000Z"})"), 409);
    ask(post("/api/occupation/checked", R"({"code":"reference","key":"20260314T081000Z"})"));
    CHECK(word() == "go");
    CHECK(level() == "good");
    REQUIRE(recorder.log.size() == 3);
    CHECK(recorder.log[2].details.at("note") == "checked: No.1 is 71.0 mGal off");
    const survey::Occupations again(recorder, {}, recorder.log);
    CHECK(again.is_checked({"reference", "20260314T081000Z", {}, {}}, minute(31)));
    CHECK_FALSE(again.is_checked({"reference", "20260314T081000Z", {}, {}}, minute(60 * 25)));
    CHECK_FALSE(again.is_checked({"reference", "L", {}, {}}, minute(31)));
    CHECK(is(ask(post("/api/occupation/checked", "{}"), 409), "/error",
             R"("there is no LOOK to answer")"));
}

TEST_CASE_METHOD(StayPage,
                 "a contradiction stays after the stop until it is checked or the figures agree") {
    const bool is_checked = GENERATE(false, true);
    contradict("lesser_contradictions", "references");
    CHECK(word() == "keep_off");  // It was not said before.
    contradict("contradictions", "reference");
    CHECK(word() == "look");
    stop();
    gravity_so_far =
        R"({"reason":"too_few_readings","contradictions":[],"lesser_contradictions":[]})";
    word();  // A day that cannot be corrected ends no contradiction.
    contradict("lesser_contradictions", "references");
    CHECK(word() == "look");
    if (is_checked)
        ask(post("/api/occupation/checked", R"({"key":"20260314T081000Z"})"));
    else
        gravity_so_far = R"({"lesser_contradictions":[]})";
    CHECK(word() == "go");
    contradict("lesser_contradictions", "references");
    CHECK(word() == "go");  // They agreed, or somebody has looked.
}

TEST_CASE_METHOD(StayPage, "after a restart the same lesser contradictions stay as without one") {
    const auto restart = [&] {
        reader = {recorder.log, [&](const auto& event) { recorder.note(event); }};
    };
    contradict("lesser_contradictions", "references");
    word();
    restart();
    CHECK(word() == "keep_off");
    contradict("contradictions", "reference");
    CHECK(word() == "look");
    restart();
    contradict("lesser_contradictions", "references");
    CHECK(word() == "look");
    CHECK(is(signal(), "/look/code", R"("reference")"));  // An answer to it holds.
    restart();
    contradict("others", "");
    word();
    restart();
    contradict("lesser_contradictions", "references");
    CHECK(word() == "keep_off");
    REQUIRE(recorder.log.size() == 3);  // The start, and begin and end of the contradiction.
    CHECK(events::to_json(recorder.log[1]) ==
          R"({"type":"contradiction","utc":"2026-03-14T08:29:00.000000000Z",)"
          R"("code":"reference","key":"20260314T081000Z"})");
    CHECK(recorder.log[2].details ==
          std::map<std::string, std::string>{{"key", "20260314T081000Z"}});
}

TEST_CASE_METHOD(StayPage,
                 "a fault of the sensor is said once, also while the signal shows the plan") {
    status.now = status.last_sample.emplace(minute(11));
    status.sensor_troubles = {"the x axis is dead"};
    status.fail("the x axis is dead");
    CHECK(word() == "look");
    CHECK(is(ask(get("/api/status")), "/reasons", R"(["the x axis is dead"])"));
}

TEST_CASE("a site is added by POST with numbers, and a malformed one is refused") {
    Page page;
    const test::TemporaryDirectory directory;
    const auto file = directory.write(
        "sites.csv", "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\nA,140,36,1,\n");
    page.occupations.use(text::read_sites(file), {.sites_file = file});
    for (const char* body :
         {R"({"site":"B","latitude_deg":36.1})", R"({"latitude_deg":36.1,"longitude_deg":140})",
          R"({"site":"B","latitude_deg":"36.1","longitude_deg":140})", "[]",
          R"({"site":1,"latitude_deg":36.1,"longitude_deg":140})",
          R"({"site":"B","latitude_deg":36.1,"longitude_deg":140,"height":2})"})
        page.ask(post("/api/sites", body), 400);
    page.ask(post("/api/sites", R"({"site":"A","latitude_deg":36.1,"longitude_deg":140})"), 409);
    page.ask(post("/api/sites", R"({"site":"B","latitude_deg":96.1,"longitude_deg":140})"), 409);
    page.ask(post("/api/sites",
                  R"({"site":"B","latitude_deg":36.1,"longitude_deg":140,"altitude_m":null})"));
    const auto list = page.ask(get("/api/sites"))["sites"];
    REQUIRE(list.size() == 2);
    const std::size_t place = list[0]["site"] == "B" ? 0 : 1;
    CHECK(list[place]["latitude_deg"].get<double>() == 36.1);
    CHECK(list[place]["altitude_m"].is_null());
    CHECK(list[place]["distance_m"].is_number());
    CHECK(is(page.ask(get("/api/sites")), "/doubt", R"("")"));

    const auto answer =
        page.ask(post("/api/sites", R"({"site":"C","latitude_deg":-36.1,"longitude_deg":140})"));
    CHECK(is(
        answer, "/message",
        json("added C: 3 sites in " + file.string() +
             "; C is 8017 km from A, the nearest other site: check longitude and latitude of both")
            .dump()));
    CHECK_THAT(page.ask(get("/api/sites"))["doubt"].get<std::string>(),
               StartsWith("C is 8017 km from"));
}

TEST_CASE("GET changes nothing, POST reads nothing, and unknown paths are answered 404") {
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
    for (const char* path : {"/api/status", "/api/events", "/api/token", "/"}) {
        const auto response = page.api.answer(post(path));
        CHECK(response.status == 405);
        CHECK(response.headers.front().first == "Allow");
    }
    const auto response = page.api.answer({"PUT", "/api/sites", {}, "{}"});
    CHECK(response.status == 405);
    CHECK(response.headers.front().second == "GET, HEAD, POST");
    for (const char* path : {"/api", "/api/status/", "/../etc/passwd", "", "*", "//api/status",
                             "http://127.0.0.1:8351/api/status", "/api/occupation"}) {
        CHECK(page.api.answer(get(path)).status == 404);
        CHECK(page.api.answer(post(path)).status == 404);
    }
    CHECK(page.recorder.log.empty());
}

TEST_CASE("the catalogue of each language is served") {
    Page page;
    for (const text::Language& one : text::other_languages()) {
        const json texts = page.ask(get("/" + std::string(one.code) + ".json"));
        CHECK(texts.at("English") == name_of(one));
    }
    CHECK(page.api.answer(get("/en.json")).status == 404);
}

TEST_CASE("events are listed from a given time on, at most 1000 per answer") {
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
                              "?since=%zz", "?since=2026-03-14T08:00:01Z&x=1"})
        page.ask(get(std::string("/api/events") + query), 400);
}

TEST_CASE("sites are listed with their gravity, null if there is none, the nearest first") {
    Page page;
    auto sites = two_sites();
    sites[0].latitude = Degrees(36.0);
    sites[1].latitude = Degrees(37.0);
    page.occupations.use(sites, {});
    const auto list = page.ask(get("/api/sites"))["sites"];
    REQUIRE(list.size() == 2);
    CHECK(is(list, "/0/site", R"("No.0")"));
    CHECK(is(list, "/0/gravity_mgal", "979948.0"));
    CHECK(is(list, "/1/gravity_mgal", "null"));
    page.ask(post("/api/occupation/start", R"({"site":"No.1"})"));
    CHECK(is(page.ask(get("/api/sites")), "/sites/0/site", R"("No.1")"));
}

TEST_CASE("the token is given out only to clients on this host") {
    Page page;
    CHECK(is(page.ask(get("/api/token")), "/token", '"' + kToken + '"'));
    CHECK(page.api.answer(get("/")).body.find(kToken) != std::string::npos);
    for (const char* path : {"/api/token", "/"}) {
        auto request = get(path);
        request.is_local = false;
        const auto response = page.api.answer(request);
        CHECK(response.status == (request.target == "/" ? 200 : 403));
        CHECK(response.body.find(kToken) == std::string::npos);
    }
}

TEST_CASE("an exception in a data source is answered 500 and counted") {
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
