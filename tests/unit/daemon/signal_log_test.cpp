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
