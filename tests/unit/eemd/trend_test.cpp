/// @file
/// The trend computed alone is bit-identical with that of the whole decomposition.

#include "tests/support/catch.hpp"

#include "corrector/eemd/extrema.hpp"
#include "tests/unit/eemd/series.hpp"

namespace a351::corrector::eemd {
namespace {

/// Returns the whole decomposition with the fewest modes that leaves a residue with few enough
/// extrema.
Result by_trial(std::span<const double> signal, std::size_t most_extrema, Options options) {
    const int most_modes = options.mode_count.value_or(default_mode_count(signal.size()));
    for (options.mode_count = 0;; ++*options.mode_count) {
        Result result = eemd(signal, options);
        if (result.residue.extrema_count <= most_extrema || *options.mode_count == most_modes)
            return result;
    }
}

void check_against_trial(std::span<const double> signal, std::size_t most_extrema,
                         const Options& options) {
    const Trend trend = eemd_trend(signal, most_extrema, options);
    const Result whole = by_trial(signal, most_extrema, options);
    CHECK(trend.values == whole.residue.values);
    CHECK(trend.removed_modes == static_cast<int>(whole.modes.size()));
}

}  // namespace

TEST_CASE("the trend computed alone is bit-identical with the residue of the whole decomposition") {
    for (const std::size_t n : {0U, 1U, 2U, 5U, 16U, 77U, 450U, 1201U}) {
        const std::vector<double> signal = mixed_series(n);
        for (const std::size_t most_extrema : {0U, 3U, 7U, 30U}) {
            INFO(n << " samples, at most " << most_extrema << " extrema");
            check_against_trial(signal, most_extrema, small_ensemble());
        }
    }
}

TEST_CASE("the trend computed alone is bit-identical with every option") {
    const std::vector<double> signal = mixed_series(300);
    Options options = small_ensemble();
    options.ends = EndRule::mirror;
    check_against_trial(signal, 7, options);
    options.reflect_ends = true;
    check_against_trial(signal, 7, options);
    options.complementary_pairs = true;
    check_against_trial(signal, 7, options);
    options.stopping = SNumber{};
    options.finish = FinishRule::always;
    check_against_trial(signal, 7, options);
    options.mode_count = 2;
    check_against_trial(signal, 0, options);
    options.noise_ratio = 0.0;
    check_against_trial(signal, 7, options);
}

TEST_CASE("the trend computed alone is bit-identical on any number of threads") {
    const std::vector<double> signal = mixed_series(450);
    Options options = small_ensemble(37);
    const Trend one = eemd_trend(signal, 7, options);
    for (const int threads : {2, 3, 7}) {
        options.threads = threads;
        CHECK(eemd_trend(signal, 7, options).values == one.values);
    }
}

TEST_CASE("computing the trend alone is refused like the whole decomposition") {
    const std::vector<double> signal = mixed_series(450);
    Options options = small_ensemble();
    options.threads = 0;
    CHECK_THROWS_AS(eemd_trend(signal, 7, options), std::invalid_argument);
}

}  // namespace a351::corrector::eemd
