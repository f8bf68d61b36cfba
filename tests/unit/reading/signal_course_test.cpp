#include "corrector/reading/signal_course.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector;
using namespace a351::corrector::reading;
using namespace std::chrono_literals;

TEST_CASE("a word lasts until the next one, but not over a pause of the recorder") {
    const auto minute = [](int k) {
        return parse_rfc3339("2020-01-01T00:00:00Z").value() + k * 1min;
    };
    std::vector<archive_series::MinuteTemperature> course;
    for (const int k : {0, 1, 2, 10, 11}) course.push_back({minute(k) + 30s, DegC(40.0)});
    const auto event = [&](int k, const char* word) {
        return events::Event{"signal", minute(k), {}, {}, {{"word", word}}};
    };
    const auto spans = signal_course({event(1, "go"),
                                       event(-60, "keep_off"),
                                       {"start", minute(2), {}, {}, {}},
                                       event(11, "look")},
                                      course);
    REQUIRE(spans.size() == 4);
    const auto is = [&](std::size_t i, int from, int to, const char* word) {
        return spans[i].start == minute(from) && spans[i].end == minute(to) &&
               spans[i].word == word;
    };
    CHECK(is(0, 0, 1, "keep_off"));
    CHECK(is(1, 1, 3, "go"));
    CHECK(is(2, 10, 11, "go"));
    CHECK(is(3, 11, 12, "look"));
    CHECK(signal_course({}, course).empty());
}
