#include "protocol/signal/decimator.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include "tests/support/catch.hpp"
#include "tests/support/white_noise.hpp"

using namespace a351::corrector::eemd;

namespace a351::signal {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Returns the outputs one by one from the definition in decimation.hpp, with the terms added from
/// the outside in.
std::vector<double> by_definition(const std::vector<double>& input,
                                  const DecimationFilter& filter) {
    const std::size_t half = filter.half_width();
    std::vector<double> output;
    for (std::size_t centre = 0; centre < input.size(); centre += filter.factor) {
        output.push_back(kMissing);
        if (centre < half || centre + half >= input.size()) continue;
        double sum = 0.0;
        for (std::size_t j = half; j >= 1; --j) {
            sum += filter.taps[half + j] * (input[centre - j] + input[centre + j]);
        }
        sum += filter.taps[half] * input[centre];
        if (std::isfinite(sum)) output.back() = sum;
    }
    return output;
}

/// Returns white noise in which about one sample in 600 is missing, and one is infinite.
std::vector<double> noise_with_gaps(std::size_t n) {
    std::vector<double> values(n);
    fill_white_noise(7, n, values);
    for (double& value : values) {
        if (std::abs(value) > 2.95) value = value > 0.0 ? kMissing : kInfinite;
    }
    return values;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

std::vector<double> in_blocks(const std::vector<double>& input, const DecimationFilter& filter,
                              int stages, auto next_size) {
    Decimator decimator(filter, stages);
    std::vector<double> output;
    for (std::size_t done = 0; done < input.size();) {
        const std::size_t size = std::min<std::size_t>(next_size(), input.size() - done);
        decimator.push(std::span(input).subspan(done, size), output);
        done += size;
    }
    decimator.finish(output);
    return output;
}

}  // namespace

TEST_CASE(
    "every output has the same bits as its definition, for any factor and length, also around a "
    "missing or infinite sample") {
    for (const int factor : {2, 3, 5, 7, 10, 13, 16, 50}) {
        const DecimationFilter filter = design_decimation(factor);
        for (const std::size_t n : {0U, 1U, 9U, 82U, 83U, 84U, 640U, 719U, 720U, 721U, 5003U}) {
            CAPTURE(factor, n);
            const std::vector<double> input = noise_with_gaps(n);
            CHECK(same_bits(decimate(input, filter), by_definition(input, filter)));
        }
    }
}

TEST_CASE("a stream fed in pieces gives the same bits as the whole series") {
    const int factor = GENERATE(2, 7, 10, 50);
    const int stages = GENERATE(1, 2, 3);
    const DecimationFilter filter = design_decimation(factor);
    const std::vector<double> input = noise_with_gaps(20'011);
    std::vector<double> whole = input;
    for (int stage = 0; stage < stages; ++stage) whole = by_definition(whole, filter);
    CAPTURE(factor, stages);
    for (const std::size_t size : {1U, 3U, 10U, 64U, 639U, 640U, 641U, 4096U, 20'011U}) {
        CAPTURE(size);
        CHECK(same_bits(in_blocks(input, filter, stages, [size] { return size; }), whole));
    }
    std::mt19937 draw(5);
    std::geometric_distribution<std::size_t> length(0.01);
    CHECK(same_bits(in_blocks(input, filter, stages, [&] { return length(draw); }), whole));
}

TEST_CASE("every variant of the inner loop gives the same bits as plain arithmetic") {
    std::vector<double> samples = noise_with_gaps(1000);
    std::vector<TapPair> pairs;
    for (std::size_t j = 0; j < 41; ++j)
        pairs.push_back({0.01 / (1.0 + static_cast<double>(j)), 7 * j, 900 - 3 * j});
    double expected[kSideBySide] = {};
    for (const TapPair& pair : pairs) {
        for (std::size_t i = 0; i < kSideBySide; ++i) {
            expected[i] += pair.tap * (samples[pair.left + i] + samples[pair.right + i]);
        }
    }
    const std::vector<SumTapPairs> variants = sum_tap_pairs_variants();
    REQUIRE(!variants.empty());
    for (const SumTapPairs sum : variants) {
        double sums[kSideBySide];
        sum(pairs, samples.data(), sums);
        for (std::size_t i = 0; i < kSideBySide; ++i) {
            CHECK((sums[i] == expected[i] || (std::isnan(sums[i]) && std::isnan(expected[i]))));
        }
    }
}

TEST_CASE("an output is available as soon as the last sample it needs") {
    Decimator decimator(design_decimation(10));
    std::vector<double> output;
    for (std::size_t i = 0; i < 3000; ++i) {
        decimator.push(std::vector<double>{1.0}, output);
        REQUIRE(output.size() == (i < 41 ? 0 : (i - 41) / 10 + 1));
    }
}

TEST_CASE("a decimator without stages, or used after its end, is refused") {
    CHECK_THROWS_AS(Decimator(design_decimation(2), 0), std::invalid_argument);
    CHECK_THROWS_AS(Decimator(design_decimation(2), -1), std::invalid_argument);
    Decimator decimator(design_decimation(2));
    std::vector<double> output;
    decimator.finish(output);
    CHECK_THROWS_AS(decimator.push(std::vector<double>{1.0}, output), std::logic_error);
    CHECK_THROWS_AS(decimator.finish(output), std::logic_error);
}

}  // namespace a351::signal
