#include "corrector/archive_series/temperature_course.hpp"

#include <cmath>

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::archive_series;
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

TEST_CASE(
    "the temperature course has means of whole minutes, without minutes that have no samples") {
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

TEST_CASE("a course without gaps has a mean at least every ten minutes, begin and end included") {
    const auto at = [](int minute) { return kCourseStart + minute * 1min; };
    std::vector<MinuteTemperature> course;
    for (const int minute : {0, 10, 20, 21}) course.push_back({at(minute), DegC(38.0)});
    CHECK(is_without_gaps(course, at(-5), at(31)));
    CHECK_FALSE(is_without_gaps(course, at(-11), at(21)));
    CHECK_FALSE(is_without_gaps(course, at(0), at(32)));
    course.erase(course.begin() + 1);
    CHECK_FALSE(is_without_gaps(course, at(0), at(21)));
    CHECK(is_without_gaps(course, at(15), at(21)));
    CHECK_FALSE(is_without_gaps({}, at(0), at(5)));
}

TEST_CASE("between two means the temperature is a straight line, outside them it is constant") {
    const auto at = [](int second) { return kCourseStart + second * 1s; };
    const std::vector<MinuteTemperature> course{{at(0), DegC(38.0)}, {at(60), DegC(39.0)}};
    CHECK(interpolated(course, {at(-100), at(0), at(15), at(30), at(60), at(90)},
                       Nanoseconds::max()) ==
          std::vector<double>{38.0, 38.0, 38.25, 38.5, 39.0, 39.0});
    const std::vector<double> near = interpolated(course, {at(-31), at(-30), at(30), at(91)}, 30s);
    CHECK(std::isnan(near[0]));
    CHECK(near[1] == 38.0);
    CHECK(std::isnan(near[2]));
    CHECK(std::isnan(near[3]));
    CHECK(std::isnan(interpolated({}, {at(0)}, Nanoseconds::max()).at(0)));
}
