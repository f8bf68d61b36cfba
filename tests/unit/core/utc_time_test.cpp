#include "protocol/core/utc_time.hpp"

#include <string>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace std::chrono;

TEST_CASE("RFC 3339 times are read to the nanosecond") {
    // 2017-07-16 is day 17363 of the Unix epoch (365 * 47 + 12 leap days + 196).
    const UtcTime midnight{days(17363)};
    CHECK(parse_rfc3339("2017-07-16T00:00:00Z") == midnight);
    CHECK(parse_rfc3339("2017-07-16 00:00:00Z") == midnight);
    CHECK(parse_rfc3339("2017-07-16T09:00:00+09:00") == midnight);
    CHECK(parse_rfc3339("2017-07-15T19:30:00-04:30") == midnight);
    CHECK(parse_rfc3339("2017-07-16T00:00:00.000000001Z") == midnight + nanoseconds(1));
    CHECK(parse_rfc3339("2017-07-16T00:00:00.0000000019Z") == midnight + nanoseconds(1));
    CHECK(parse_rfc3339("2016-02-29T00:00:00Z").has_value());
}

TEST_CASE("text that is not an RFC 3339 time is refused") {
    const std::string bad =
        GENERATE("", "2017-07-16", "2017-07-16T00:00:00", "2017-02-29T00:00:00Z",
                 "2017-07-16T24:00:00Z", "2017-07-16T00:60:00Z", "2017-07-16T00:00:60Z",
                 "2017-07-16T00:00:00.Z", "2017-07-16T00:00:00Zx", "2017-7-16T00:00:00Z",
                 "2017-07-16T00:00:00+9:00", "2017-07-16T00:00:00+24:00", "1500-01-01T00:00:00Z",
                 "2300-01-01T00:00:00Z", "20l7-07-16T00:00:00Z");
    CAPTURE(bad);
    CHECK_FALSE(parse_rfc3339(bad).has_value());
}

TEST_CASE("the default time zone applies only to a time without a zone") {
    const UtcTime expected = *parse_rfc3339("2017-07-15T23:42:12Z");
    CHECK(parse_rfc3339_in_zone("2017-07-16T08:42:12", hours(9)) == expected);
    CHECK(parse_rfc3339_in_zone("2017-07-15T23:42:12Z", hours(9)) == expected);
}

TEST_CASE("the seconds between any two instants are a number, also over more than 292 years") {
    const UtcTime early = *parse_rfc3339("1690-03-01T00:00:00Z"),
                  late = *parse_rfc3339("2020-03-01T00:00:00Z");
    constexpr double kDays = 120530.0;
    CHECK(seconds_between(early, late) == Approx(kDays * 86400.0).epsilon(1e-12));
    CHECK(seconds_between(late, early) == Approx(-kDays * 86400.0).epsilon(1e-12));
    CHECK(seconds_between(late, late + Nanoseconds(1)) == 1e-9);
}

TEST_CASE("a time is unchanged after writing and reading") {
    const UtcTime time =
        GENERATE(UtcTime(nanoseconds(0)), UtcTime(nanoseconds(-1)),
                 UtcTime(nanoseconds(1500166800123456789)), UtcTime(nanoseconds(-86400000000001)));
    CHECK(parse_rfc3339(to_rfc3339(time, 9)) == time);
    CHECK(to_rfc3339(UtcTime(nanoseconds(1500166800999999999)), 3) == "2017-07-16T01:00:00.999Z");
}
