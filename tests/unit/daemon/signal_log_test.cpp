#include "daemon/survey/operator_signal.hpp"

#include <map>

#include "tests/unit/daemon/asked_page.hpp"
#include "tests/unit/live/live_samples.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::page;

namespace {

/// Gives the page a second of samples at 50 Hz of a box that is shaken.
void take_second(Page& page, int second, double x_mgal, double z_mgal, double shaken_mgal = 0.0) {
    for (std::int64_t i = 50 * second; i < 50 * (second + 1); ++i) {
        auto sample = live::placed(i, x_mgal + shaken_mgal * std::sin(double(i)), 0.0, z_mgal);
        sample.counts[3] += second / 60 % 2;  // Else the temperature seems to be frozen.
        page.live.take(sample);
    }
}

}  // namespace

TEST_CASE("the log has each word with the time of the data, however seldom it is written") {
    const auto logged = [](int step_s) {
        Page page;
        std::vector<std::string> words;
        survey::SignalLog log(page.occupations, page.live, [&](const events::Event& event) {
            words.push_back(event.details.at("word") + " " + to_rfc3339(event.utc).substr(11));
        });
        page.occupations.use(two_sites(),
                             {.planned = std::chrono::minutes(4), .planned_set_ups = 2});
        for (int second = 0; second < 2400; ++second) {
            if (second == 1500) {
                log.advance(page.status, {});
                page.recorder.last = minute(25);
                page.ask(post("/api/occupation/start", R"({"site":"No.0"})"));
            }
            take_second(page, second, 100.0, 980000.0);
            if (second % step_s == 0) log.advance(page.status, {});
        }
        log.advance(page.status, {});
        return words;
    };
    const auto often = logged(1);
    CHECK(often == std::vector<std::string>{"no_data 08:00:00Z", "go 08:00:20Z",
                                            "keep_off 08:25:00Z", "lift 08:27:00Z"});
    CHECK(logged(600) == often);
}

TEST_CASE(
    "a start while a stay runs says when the box was carried away, and the rows how to stop then") {
    Page page;
    page.recorder.last = minute(10);
    page.ask(post("/api/occupation/start", R"({"site":"No.0"})"));
    const auto record = [&](int from_s, int to_s, double shaken_mgal) {
        for (int second = from_s; second < to_s; ++second)
            take_second(page, second, 100.0, 980000.0, shaken_mgal);
        page.status.now = page.status.last_sample.emplace(live::after(to_s));
        page.status.verdict.state = verdict::State::stable;
        return page.ask(post("/api/occupation/start", R"({"site":"No.1"})"), 409)["error"]
            .get<std::string>();
    };
    CHECK(record(0, 1200, 0.0).ends_with("stop or discard it first"));
    const std::string answer = record(1200, 1500, 20000.0);
    const auto at = answer.find("; the box was moved at 2026-03-14T08:");
    REQUIRE(at != std::string::npos);
    CHECK(answer.find(": a351ctl stop --at 2026-03-14T08:", at) != std::string::npos);
    const json rows = page.ask(get("/api/rows"))["rows"];
    CHECK(is(rows, "/2/label", R"("commands")"));
    const auto commands = rows.at(2).at("text").get<std::string>();
    CHECK(commands.starts_with("a351ctl stop --at 2026-03-14T08:"));
    CHECK(commands.ends_with("Z, or a351ctl not-moved"));
}

TEST_CASE("a turn that was forgotten, a box on its side and a face entered wrong are LOOK") {
    struct Box {
        double x_mgal, z_mgal;
    };
    static constexpr Box kUp{100.0, 980000.0}, kDown{100.0, -980000.0}, kOnItsSide{980000.0, 100.0};
    struct Seen {
        std::vector<std::string> words;
        std::string look;
        std::map<std::string, std::string> logged;  ///< Details of the first set-up's event.
    };
    // The stay begins at 1500 s, the next set-up at 1650 s; from 1760 s the box is in the planned face.
    // Each turn takes ten seconds.
    const auto day_of = [](Box box, const std::string& entered, int turned_s = 1650) {
        Page page;
        Seen seen;
        survey::SignalLog log(page.occupations, page.live, [&](const events::Event& event) {
            seen.words.push_back(event.details.at("word"));
        });
        page.occupations.use(
            two_sites(), {.planned = std::chrono::minutes(4), .planned_set_ups = 2, .faces = "+-"});
        std::string lifted;
        for (int second = 0; second < 1940; ++second) {
            page.recorder.last = minute(0) + std::chrono::seconds(second);
            if (second == 1500) page.ask(post("/api/occupation/start", R"({"site":"No.0"})"));
            if (second == 1650) {
                log.advance(page.status, {});
                lifted = survey::signal_of({verdict::State::stable, {}, {}}, {},
                                           survey::planned_stay(page.occupations, page.live,
                                                                page.recorder.last.value()),
                                           "", {})
                             .sentence.english();
                page.ask(post("/api/occupation/setup", R"({"site":"No.0")" + entered + "}"));
                seen.logged = page.recorder.log.back().details;
            }
            if (second == 1759)
                seen.look = survey::wrong_face(page.occupations, page.live,
                                               minute(0) + std::chrono::seconds(second))
                                .english();
            if (second == 1760 && !seen.look.empty())
                page.ask(post("/api/occupation/setup", R"({"site":"No.0"})"));
            const Box& is = second < turned_s ? kUp : second < 1760 ? box : kDown;
            const auto is_in = [second](int first, bool turns) {
                return turns && first <= second && second < first + 10;
            };
            const bool is_in_hands = is_in(turned_s, box.z_mgal != kUp.z_mgal) ||
                                     is_in(1760, box.z_mgal != kDown.z_mgal);
            take_second(page, second, is.x_mgal, is.z_mgal, is_in_hands ? 20000.0 : 0.0);
            log.advance(page.status, {});
        }
        CHECK(lifted ==
              "No.0: set-up 1 of 2 is complete. Turn the box over, set it down level, then "
              "press Next set-up.");
        return seen;
    };
    const std::vector<std::string> looked{"no_data",  "go",   "keep_off", "lift",
                                          "keep_off", "look", "keep_off", "go"};
    const Seen turned = day_of(kDown, "");
    CHECK(turned.words ==
          std::vector<std::string>{"no_data", "go", "keep_off", "lift", "keep_off", "go"});
    CHECK(turned.logged ==
          std::map<std::string, std::string>{{"planned_face", "-"}, {"site", "No.0"}});
    // The next set-up was entered before the box was turned, or after it.
    CHECK(day_of(kDown, "", 1665).words == turned.words);
    CHECK(day_of(kDown, "", 1630).words == turned.words);
    const Seen forgotten = day_of(kUp, "");
    CHECK(forgotten.words == looked);
    CHECK(forgotten.look.starts_with("the box is not in the face that is planned for set-up 2"));
    const Seen laid = day_of(kOnItsSide, "");
    CHECK(laid.words == looked);
    CHECK(laid.look.starts_with(events::kOnItsSide));
    const Seen wrong = day_of(kDown, R"(,"face":"+")");
    CHECK(wrong.look.starts_with("the box is in face -, but face + was entered"));
    CHECK(wrong.logged.at("face") == "+");
    CHECK(day_of(kDown, R"(,"face":"-")").words == turned.words);
    CHECK(day_of(kUp, R"(,"face":"+")").look.empty());  // it stays up on purpose
}
