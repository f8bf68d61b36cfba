#include <functional>
#include <limits>
#include "tests/support/catch.hpp"

#include "tests/unit/eemd/series.hpp"

namespace a351::corrector::eemd {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Options> every_kind() {
    std::vector<Options> kinds;
    for (const double noise_ratio : {0.0, 0.1})
        for (const StoppingRule& stopping :
             {StoppingRule(FixedSifts{10}), StoppingRule(SNumber{4})})
            for (const FinishRule finish : {FinishRule::at_most_two_extrema, FinishRule::always})
                for (const int members : {1, 9}) {
                    Options options;
                    options.ensemble_size = members;
                    options.noise_ratio = noise_ratio;
                    options.stopping = stopping;
                    options.finish = finish;
                    options.mode_count = 6;
                    kinds.push_back(options);
                    options.ends = EndRule::mirror;
                    options.reflect_ends = true;
                    kinds.push_back(options);
                }
    return kinds;
}

/// Checks that all components are finite and of the right length, and that their sum is the signal
/// except for the mean noise.
void check_sane(const std::vector<double>& signal) {
    for (const Options& options : every_kind()) {
        const Result result = eemd(signal, options);
        CHECK(result.modes.size() == 6);
        for (const auto& component : components_of(result)) {
            CHECK(component.size() == signal.size());
            for (const double value : component) REQUIRE(std::isfinite(value));
        }
        CHECK(closure_error(signal, result) <=
              9.0 * result.noise_level + 1e-13 * largest_magnitude(signal));
    }
}

}  // namespace

TEST_CASE("series of 0 to 8 samples can be decomposed") {
    for (std::size_t n = 0; n <= 8; ++n) check_sane(white_noise(n, n));
}

TEST_CASE("a constant has zero modes and is its own residue, with and without noise") {
    for (const double value : {0.0, 9.80665, -1e-300}) {
        const std::vector<double> signal(64, value);
        for (const Options& options : every_kind()) {
            const Result result = eemd(signal, options);
            for (const Component& mode : result.modes) CHECK(largest_magnitude(mode.values) == 0.0);
            CHECK(result.residue.values == signal);
            CHECK(result.noise_level == 0.0);
        }
    }
}

TEST_CASE("difficult shapes can be decomposed") {
    const std::vector<std::pair<const char*, std::function<double(int)>>> shapes{
        {"constant except for rounding", [](int i) { return 98e4 + (i % 3 == 0 ? 1.2e-10 : 0.0); }},
        {"monotone", [](int i) { return i * i; }},
        {"step", [](int i) { return i < 20 ? 0.0 : 1.0; }},
        {"single spike", [](int i) { return i == 20 ? 1.0 : 0.0; }},
        {"alternating", [](int i) { return i % 2 == 0 ? 1.0 : -1.0; }},
        {"plateaus at the ends", [](int i) { return i < 8 || i > 50 ? 0.0 : std::sin(i); }},
        {"near overflow", [](int i) { return 1e300 * std::sin(i); }},
        {"subnormal", [](int i) { return 1e-310 * std::sin(i); }}};
    for (const auto& [name, shape] : shapes) {
        CAPTURE(name);
        std::vector<double> signal;
        for (int i = 0; i < 64; ++i) signal.push_back(shape(i));
        check_sane(signal);
    }
}

TEST_CASE("a tone with four samples per period stays in the first mode") {
    std::vector<double> signal(256);
    for (std::size_t i = 0; i < signal.size(); ++i)
        signal[i] = i % 4 == 0 ? 1.0 : (i % 4 == 2 ? -1.0 : 0.0);
    check_sane(signal);
    const Result result = eemd(signal, plain());
    CHECK(result.modes[0].mean_period_samples == Approx(4.0).epsilon(0.02));
    CHECK(result.modes[0].energy_share > 0.99);
}

TEST_CASE("a record of a million samples can be decomposed") {
    const std::vector<double> signal = white_noise(1'000'000, 3);
    Options options = plain();
    options.mode_count = 4;
    options.stopping = FixedSifts{2};
    const Result result = eemd(signal, options);
    CHECK(closure_error(signal, result) <= 1e-12);
    CHECK(result.modes[0].mean_period_samples > 2.0);
}

TEST_CASE("a sample that is not finite, or too large to add noise, is refused with its index") {
    for (const double bad : {kNan, kInfinity, -kInfinity, -1.7e308}) {
        std::vector<double> signal = white_noise(32, 1);
        signal[17] = bad;
        CHECK_THROWS_AS(eemd(signal), std::invalid_argument);
        CHECK_THROWS_WITH(eemd(signal), ContainsSubstring("signal[17]"));
    }
}

}  // namespace a351::corrector::eemd
