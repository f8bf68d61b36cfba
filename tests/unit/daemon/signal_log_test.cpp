#include "daemon/survey/operator_signal.hpp"

#include "tests/support/catch.hpp"
#include "tests/unit/daemon/asked_page.hpp"
#include "tests/unit/live/live_samples.hpp"

using namespace a351;
using namespace a351::daemon;
using namespace a351::daemon::page;

TEST_CASE("the log has each word with the time of the data, however seldom it is written",
          "[daemon][page]") {
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
            for (std::int64_t i = 50 * second; i < 50 * (second + 1); ++i) {
                auto sample = live::placed(i, 100.0, 0.0, 980000.0);
                sample.counts[3] += second / 60 % 2;  // Else the temperature seems to be frozen.
                page.live.take(sample);
            }
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

TEST_CASE("a turn that was forgotten is LOOK and does not count, and a planned one is not",
          "[daemon][page][faces]") {
    const auto words_of = [](bool turns) {
        Page page;
        std::vector<std::string> words;
        survey::SignalLog log(page.occupations, page.live, [&](const events::Event& event) {
            words.push_back(event.details.at("word"));
        });
        page.occupations.use(
            two_sites(), {.planned = std::chrono::minutes(4), .planned_set_ups = 2, .faces = "+-"});
        std::string lifted;
        for (int second = 0; second < 1900; ++second) {
            page.recorder.last = minute(0) + std::chrono::seconds(second);
            if (second == 1500) page.ask(post("/api/occupation/start", R"({"site":"No.0"})"));
            if (second == 1650) {
                log.advance(page.status, {});
                lifted = page.occupations.running()
                             ? survey::signal_of({verdict::State::stable, {}, {}}, {},
                                                 survey::planned_stay(page.occupations, page.live,
                                                                      page.recorder.last.value()),
                                                 "", {})
                                   .sentence.english()
                             : "";
                page.ask(post("/api/occupation/setup", R"({"site":"No.0"})"));
            }
            if (second == 1740 && !turns)
                page.ask(post("/api/occupation/setup", R"({"site":"No.0"})"));
            const double z_mgal = second >= (turns ? 1650 : 1740) ? -980000.0 : 980000.0;
            for (std::int64_t i = 50 * second; i < 50 * (second + 1); ++i) {
                auto sample = live::placed(i, 100.0, 0.0, z_mgal);
                sample.counts[3] += second / 60 % 2;
                page.live.take(sample);
            }
            log.advance(page.status, {});
        }
        CHECK(lifted ==
              "No.0: set-up 1 of 2 is complete. Turn the box over, set it down level, then "
              "press Next set-up.");
        return words;
    };
    CHECK(words_of(true) ==
          std::vector<std::string>{"no_data", "go", "keep_off", "lift", "keep_off", "go"});
    CHECK(words_of(false) == std::vector<std::string>{"no_data", "go", "keep_off", "lift",
                                                      "keep_off", "look", "keep_off", "go"});
}
