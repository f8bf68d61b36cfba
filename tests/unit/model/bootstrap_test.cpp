#include <cmath>
#include <string>
#include <vector>
#include "tests/support/catch.hpp"

#include "corrector/model/linear_models.hpp"

using namespace a351;
using namespace a351::corrector::model;

TEST_CASE("the interval of many equal stations agrees with the error of a mean of squares") {
    // Squares 0 and 4 on 400 stations, in halves: their mean is 2 +- 2 / sqrt(400) = 0.1, so the
    // root is 1.414 +- 1.96 x 0.1 / (2 x 1.414).
    std::vector<double> errors;
    std::vector<std::string> stations;
    for (int i = 0; i < 400; ++i) {
        errors.push_back(i % 2 == 0 ? 0.0 : 2.0);
        stations.push_back(std::to_string(i));
    }
    const Interval interval = bootstrap_rms_interval(errors, stations, 1).value();
    CHECK(interval.low == Approx(1.414 - 0.0693).margin(0.01));
    CHECK(interval.high == Approx(1.414 + 0.0693).margin(0.01));

    // Rows of one station are drawn together; four rows per station double the width.
    for (int i = 0; i < 400; ++i) {
        stations[static_cast<std::size_t>(i)] = std::to_string(i % 100);
        errors[static_cast<std::size_t>(i)] = i % 100 < 50 ? 0.0 : 2.0;
    }
    const Interval wide = bootstrap_rms_interval(errors, stations, 1).value();
    CHECK(wide.low == Approx(1.414 - 2 * 0.0693).margin(0.02));
    CHECK(wide.high == Approx(1.414 + 2 * 0.0693).margin(0.02));
}

TEST_CASE("the same seed gives the same interval, another seed gives another one") {
    std::vector<double> errors;
    std::vector<std::string> stations;
    for (int i = 0; i < 20; ++i) {
        errors.push_back(std::sin(i));
        stations.push_back(std::to_string(i));
    }
    const auto low = [&](std::uint64_t seed) {
        return bootstrap_rms_interval(errors, stations, seed).value().low;
    };
    CHECK(low(7) == low(7));
    CHECK(low(7) != low(8));
    CHECK_FALSE(bootstrap_rms_interval({1.0, 2.0}, {"A", "A"}, 1).has_value());
}
