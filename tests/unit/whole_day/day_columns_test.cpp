#include "corrector/whole_day/day_columns.hpp"

#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector::reading;
using namespace a351::corrector::whole_day;

namespace {

const UtcTime kStart = *parse_rfc3339("2026-05-01T00:00:00Z");

}  // namespace

TEST_CASE("bin means are averages of the grid at the times of their samples") {
    const TimeSeries<DegC> grid(kStart, Hertz(0.5), {0.0, 10.0, 20.0, 30.0});
    DayBin bin;
    bin.times = {kStart + from_seconds(1.0), kStart + from_seconds(4.0)};
    DayBin outside;
    outside.times = {kStart - from_seconds(5.0), kStart + from_seconds(60.0)};
    const auto means = BinMeans(grid, {bin, outside}).of(grid.values());
    CHECK(means(0) == Approx(12.5));
    CHECK(means(1) == Approx(15.0));
}
