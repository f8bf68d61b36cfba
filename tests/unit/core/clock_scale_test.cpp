#include "protocol/core/clock_scale.hpp"

#include <string>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace std::chrono;

namespace {
const UtcTime kHost = *parse_rfc3339("2026-01-01T00:00:00Z");
const UtcTime kDay = *parse_rfc3339("2017-07-15T20:42:12Z");
}  // namespace

TEST_CASE("simulated time begins at UTC and runs FACTOR times as fast") {
    const auto scale = parse_clock_scale("scaled:1000@2017-07-15T20:42:12Z", kHost);
    REQUIRE(scale);
    CHECK(scale->simulated(kHost) == kDay);
    CHECK(scale->simulated(kHost + milliseconds(1)) == kDay + seconds(1));
    CHECK(scale->host_at(kDay + hours(1)) == kHost + milliseconds(3600));
}

TEST_CASE("programs that are given the same HOST time agree on the simulated time") {
    const std::string text = "scaled:20@2017-07-15T20:42:12Z,2026-01-01T00:00:00Z";
    const UtcTime now = kHost + hours(2);
    CHECK(parse_clock_scale(text, kHost).value().simulated(now) ==
          parse_clock_scale(text, kHost + hours(1)).value().simulated(now));
}

TEST_CASE("a malformed clock setting is refused") {
    const std::string bad =
        GENERATE("", "scaled:", "scaled:1000", "scaled:x@2017-07-15T20:42:12Z",
                 "scaled:0@2017-07-15T20:42:12Z", "scaled:-1@2017-07-15T20:42:12Z",
                 "scaled:nan@2017-07-15T20:42:12Z", "scaled:2e6@2017-07-15T20:42:12Z",
                 "scaled:1@2017-07-15", "scaled:1@2017-07-15T20:42:12Z,", "1@2017-07-15T20:42:12Z");
    CAPTURE(bad);
    CHECK_FALSE(parse_clock_scale(bad, kHost).has_value());
}
