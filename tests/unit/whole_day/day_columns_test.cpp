#include "corrector/whole_day/day_columns.hpp"

#include <cmath>
#include "tests/support/catch.hpp"

using namespace a351;
using namespace a351::corrector;

namespace {

const UtcTime kStart = *parse_rfc3339("2026-05-01T00:00:00Z");

}  // namespace

TEST_CASE("a ramp after a first-order lag agrees with the exact solution", "[day]") {
    std::vector<double> ramp(2000);
    for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = 40.0 + 0.001 * static_cast<double>(i);
    const double tau_s = 43.0;
    const auto y = lagged({kStart, Hertz(0.5), ramp}, tau_s);
    CHECK(y.front() == ramp.front());
    for (const std::size_t i : {std::size_t{1}, std::size_t{20}, std::size_t{1999}}) {
        const double t_s = 2.0 * static_cast<double>(i);
        const double exact = 40.0 + 0.0005 * (t_s - tau_s * (1.0 - std::exp(-t_s / tau_s)));
        CHECK(y[i] == Approx(exact).epsilon(1e-13));
    }
}

TEST_CASE("bin means are averages of the grid at the times of their samples", "[day]") {
    const TimeSeries<DegC> grid(kStart, Hertz(0.5), {0.0, 10.0, 20.0, 30.0});
    DayBin bin;
    bin.times = {kStart + from_seconds(1.0), kStart + from_seconds(4.0)};
    DayBin outside;
    outside.times = {kStart - from_seconds(5.0), kStart + from_seconds(60.0)};
    const auto means = BinMeans(grid, {bin, outside}).of(grid.values());
    CHECK(means(0) == Approx(12.5));
    CHECK(means(1) == Approx(15.0));
}
