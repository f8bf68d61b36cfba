#include "tests/support/catch.hpp"

#include "tests/unit/eemd/series.hpp"

namespace a351::corrector::eemd {

TEST_CASE("modes and residue of plain EMD add up to the signal") {
    for (const std::size_t n : {16U, 450U, 5400U}) {
        std::vector<double> signal = mixed_series(n);
        for (double& value : signal) value += 980'000.0;
        const Result result = eemd(signal, plain());
        const double ulp =
            std::nextafter(largest_magnitude(signal), HUGE_VAL) - largest_magnitude(signal);
        CHECK(closure_error(signal, result) <=
              8.0 * ulp * static_cast<double>(result.modes.size() + 1));
        CHECK(result.noise_level == 0.0);
        CHECK_FALSE(result.residue.standard_error);
    }
}

TEST_CASE("an inverted signal has inverted components, bit for bit") {
    std::vector<double> signal = mixed_series(450);
    const auto upright = components_of(eemd(signal, plain()));
    for (double& value : signal) value = -value;
    auto flipped = components_of(eemd(signal, plain()));
    for (auto& component : flipped)
        for (double& value : component) value = 0.0 - value;
    CHECK(flipped == upright);
}

TEST_CASE("a signal reversed in time has components reversed in time") {
    std::vector<double> signal = mixed_series(450);
    const auto forward = components_of(eemd(signal, plain()));
    std::reverse(signal.begin(), signal.end());
    auto backward = components_of(eemd(signal, plain()));
    for (std::size_t k = 0; k < forward.size(); ++k) {
        std::reverse(backward[k].begin(), backward[k].end());
        for (std::size_t i = 0; i < signal.size(); ++i)
            REQUIRE(backward[k][i] == Approx(forward[k][i]).margin(1e-9));
    }
}

TEST_CASE("a trend without extrema stays in the residue, unless the finish rule is always") {
    std::vector<double> signal(256);
    for (std::size_t i = 0; i < signal.size(); ++i)
        signal[i] = std::exp(0.01 * static_cast<double>(i));
    Options options = plain();
    const Result whole = eemd(signal, options);
    CHECK(whole.residue.values == signal);
    for (const Component& mode : whole.modes) CHECK(largest_magnitude(mode.values) == 0.0);
    options.finish = FinishRule::always;
    CHECK(rms(eemd(signal, options).modes[0].values) > 0.05 * rms(signal));
}

TEST_CASE("every decomposition has the requested number of modes") {
    Options options = plain();
    for (const int count : {0, 1, 5, 30}) {
        options.mode_count = count;
        const Result result = eemd(mixed_series(100), options);
        CHECK(result.modes.size() == static_cast<std::size_t>(count));
        CHECK(closure_error(mixed_series(100), result) < 1e-13);
    }
    CHECK(eemd(mixed_series(64), plain()).modes.size() == 5);
    CHECK(eemd(mixed_series(63), plain()).modes.size() == 4);
}

TEST_CASE("a mode reports its number of extrema and its mean period") {
    const Result result = eemd(tone(400, 20.0, -4.7), plain());
    CHECK(result.modes[0].extrema_count == 40);
    CHECK(result.modes[0].mean_period_samples == 20.0);
    CHECK(std::isinf(eemd(std::vector<double>(64, 1.0), plain()).residue.mean_period_samples));
}

}  // namespace a351::corrector::eemd
