#include "corrector/reading/disturbance.hpp"

#include <array>
#include <cmath>
#include "tests/support/catch.hpp"
#include "tests/support/white_noise.hpp"

using namespace a351::corrector::eemd;

namespace a351::corrector::reading {
namespace {

std::vector<double> noisy_ramp(std::size_t n, double slope) {
    std::vector<double> series(n);
    fill_white_noise(3, 0, series);
    for (std::size_t i = 0; i < n; ++i) series[i] += 980'000.0 + slope * static_cast<double>(i);
    return series;
}

std::vector<std::size_t> indices(const Disturbances& found) {
    const std::vector<bool>& flags = found.disturbed;
    std::vector<std::size_t> set;
    for (std::size_t i = 0; i < flags.size(); ++i) {
        if (flags[i]) set.push_back(i);
    }
    return set;
}

}  // namespace

TEST_CASE("noise on a drift of any slope is not a disturbance, not even at the ends") {
    for (const double slope : {0.0, 0.05, -1.0, 20.0})
        CHECK(indices(find_disturbances(noisy_ramp(450, slope), 8.0)).empty());
}

TEST_CASE("quiet parts end at knocks and at missing samples") {
    std::vector<double> series = noisy_ramp(400, 0.0);
    for (std::size_t i = 100; i < 104; ++i) series[i] += 50.0;  // a knock
    for (const std::size_t i : {250UL, 251UL, 260UL}) series[i] = std::nan("");
    const auto parts = quiet_parts(series, 8.0, 20);
    REQUIRE(parts.size() == 3);
    const std::array<std::size_t, 3> starts{0, 104, 261}, sizes{100, 146, 139};
    for (std::size_t k = 0; k < 3; ++k) {
        CHECK(parts[k].size() == sizes.at(k));
        CHECK(parts[k].front() == series[starts.at(k)]);
    }
    CHECK(quiet_parts(series, 8.0, 147).empty());
    CHECK(quiet_parts({}, 8.0, 1).empty());
}

TEST_CASE("a ramp without any noise has no disturbance") {
    std::vector<double> ramp(300);
    for (std::size_t i = 0; i < ramp.size(); ++i)
        ramp[i] = 980'000.0 + 0.001 * static_cast<double>(i);
    CHECK(indices(find_disturbances(ramp, 8.0)).empty());
    CHECK(indices(find_disturbances(std::vector<double>(300, 5.0), 8.0)).empty());
}

TEST_CASE("a sample is disturbed above the threshold and not below it") {
    // With unit noise and the scale estimated from it, 10 is well between 8 and 14.
    for (const std::size_t at : {0U, 7U, 40U, 200U, 449U}) {
        auto series = noisy_ramp(450, 0.02);
        series[at] = 980'000.0 + 0.02 * static_cast<double>(at) + 10.0;
        CHECK(indices(find_disturbances(series, 8.0)) == std::vector<std::size_t>{at});
        CHECK(indices(find_disturbances(series, 14.0)).empty());
        series[at] -= 16.0;
        CHECK(indices(find_disturbances(series, 8.0)).empty());
    }
}

TEST_CASE("a decaying transient in the first samples is detected completely") {
    auto series = noisy_ramp(450, 0.02);
    for (std::size_t i = 0; i < 12; ++i) series[i] += 40.0 - 2.5 * static_cast<double>(i);
    const auto found = indices(find_disturbances(series, 8.0));
    REQUIRE(found.size() == 12);
    CHECK(found.front() == 0);
    CHECK(found.back() == 11);
}

TEST_CASE("the baseline is the undisturbed level, also under a transient at the start") {
    auto series = noisy_ramp(450, 0.02);
    for (std::size_t i = 0; i < 12; ++i) series[i] += 40.0 - 2.5 * static_cast<double>(i);
    const auto baseline = find_disturbances(series, 8.0).baseline;
    for (std::size_t i = 0; i < series.size(); ++i) {
        // Near the end the slope of 31 pairs, 12 of them disturbed, is extrapolated by 30 samples.
        // A bias of 1.2 and a scatter of 0.6 are expected there; the transient is 40.
        REQUIRE(baseline[i] - 980'000.0 - 0.02 * static_cast<double>(i) == Approx(0.0).margin(3.0));
    }
}

TEST_CASE("series of 0 to 70 samples are accepted") {
    for (std::size_t n = 0; n <= 70; ++n)
        CHECK(find_disturbances(std::vector<double>(n, 1.0), 8.0).disturbed.size() == n);
}

TEST_CASE("despiking replaces the disturbed samples by the baseline and no others") {
    const std::vector<double> quiet = noisy_ramp(400, 0.05);
    std::vector<double> struck = quiet;
    for (std::size_t i = 5; i < 15; ++i) struck[i] += 1000.0;
    struck[200] -= 40.0;
    struck[399] += 1e6;
    const Disturbances found = find_disturbances(struck, 8.0);
    REQUIRE(indices(found).size() == 12);
    const std::vector<double> samples = despike(struck, found);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (found.disturbed[i]) {
            CHECK(samples[i] == found.baseline[i]);
            CHECK(std::abs(samples[i] - 980'000.0 - 0.05 * static_cast<double>(i)) <
                  3.0);  // standard deviations of the noise
        } else {
            CHECK(samples[i] == quiet[i]);
        }
    }
    CHECK(indices(find_disturbances(samples, 8.0)).empty());
}

}  // namespace a351::corrector::reading
