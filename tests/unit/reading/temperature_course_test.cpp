#include "corrector/reading/temperature_course.hpp"
#include "corrector/reading/verdict_course.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::reading;
using namespace std::chrono_literals;

namespace {

const UtcTime kCourseStart = parse_rfc3339("2020-01-01T00:00:30Z").value();
const station::ChannelScale kCourseScale{"BK1", 0.5, 40.0, "degC"};  // gain, offset

/// Returns two records of a sensor faster than its nominal 1 Hz, each with its own time stamp.
archive::Segment segment(UtcTime start, std::int32_t first, std::int32_t second) {
    archive::Segment result;
    result.rate_hz = 1.0;
    result.counts.assign(32, first);
    result.counts.resize(62, second);
    result.anchors = {{0, start}, {32, start + 30s}};
    return result;
}

}  // namespace

TEST_CASE("the temperature course has means of whole minutes, without minutes that have no samples",
          "[survey][temperature]") {
    const auto course = temperature_course(
        {segment(kCourseStart, 2, 6), segment(kCourseStart + 10min, 8, 8)}, kCourseScale);
    REQUIRE(course.size() == 4);
    CHECK(course[0].middle == parse_rfc3339("2020-01-01T00:00:30Z").value());
    CHECK(course[0].mean == DegC(41.0));  // 30 samples of 2
    CHECK(course[1].middle == parse_rfc3339("2020-01-01T00:01:30Z").value());
    CHECK(course[1].mean.value() == Approx(40.0 + 0.5 * (2 * 2 + 30 * 6) / 32.0));
    CHECK(course[2].middle == parse_rfc3339("2020-01-01T00:10:30Z").value());
    CHECK(course[3].mean == DegC(44.0));
    CHECK(temperature_course({}, kCourseScale).empty());
}

TEST_CASE("a verdict lasts until the next one, but not over a pause of the recorder",
          "[survey][temperature]") {
    const auto minute = [](int k) { return kCourseStart - 30s + k * 1min; };
    std::vector<MinuteTemperature> course;
    for (const int k : {0, 1, 2, 10, 11}) course.push_back({minute(k) + 30s, DegC(40.0)});
    const auto event = [&](int k, const char* state) {
        return events::Event{"verdict", minute(k), {}, {}, {{"state", state}}};
    };
    const auto spans = verdict_course({event(1, "stable"),
                                       event(-60, "settling"),
                                       {"start", minute(2), {}, {}, {}},
                                       event(11, "disturbed")},
                                      course);
    REQUIRE(spans.size() == 4);
    const auto is = [&](std::size_t i, int from, int to, const char* state) {
        return spans[i].start == minute(from) && spans[i].end == minute(to) &&
               spans[i].state == state;
    };
    CHECK(is(0, 0, 1, "settling"));
    CHECK(is(1, 1, 3, "stable"));
    CHECK(is(2, 10, 11, "stable"));
    CHECK(is(3, 11, 12, "disturbed"));
    CHECK(verdict_course({}, course).empty());
}
