#include "corrector/noise/allan_deviation.hpp"

#include <array>
#include <cstdio>

#include "tests/support/long_tests.hpp"
#include "tests/unit/noise/known_noise.hpp"

using namespace a351;
using namespace a351::corrector::noise;

namespace {

struct Share {
    int inside = 0, all = 0, unlimited = 0;
    double width = 0.0;  ///< Mean ratio of the upper limit to the truth, where there is one.
    void add(const Limits& limits, double truth) {
        ++all;
        if (std::isinf(limits.high))
            ++unlimited;
        else if (truth > 0.0)
            width += (limits.high / truth - width) / (all - unlimited);
        inside += limits.low <= truth && truth <= limits.high ? 1 : 0;
    }
    [[nodiscard]] double value() const { return static_cast<double>(inside) / all; }
};

/// Levels per sample of the three noises.
struct Known {
    const char* name;
    double white, flicker, walk;
};

}  // namespace

TEST_CASE("the limits contain the Allan deviation and the levels of known noises") {
    const int records = test::is_long() ? 500 : 60;
    constexpr std::size_t kSamples = 1024;
    Share pooled;
    for (const Known& known : {Known{"white", 2.0, 0.0, 0.0}, Known{"flicker", 0.0, 1.0, 0.0},
                               Known{"walk", 0.0, 0.0, 0.1}, Known{"sum", 2.0, 0.5, 0.1}}) {
        const ThreeNoises truth{
            {known.white * std::sqrt(kStep_s)}, {known.flicker}, {known.walk / std::sqrt(kStep_s)}};
        std::vector<Share> points;
        std::array<Share, 3> levels;
        int described = 0;
        for (int record = 0; record < records; ++record) {
            const auto seed = static_cast<std::uint64_t>(record);
            const auto white = white_noise(kSamples, known.white, seed),
                       flicker = flicker_noise(kSamples, known.flicker, seed),
                       walk = random_walk(kSamples, known.walk, seed);
            std::vector<double> values(kSamples, 979800.0);
            for (std::size_t i = 0; i < kSamples; ++i) values[i] += white[i] + flicker[i] + walk[i];
            const AllanAnalysis found = analyse_allan(values, kStep_s);
            described += found.noises.describes_record ? 1 : 0;
            points.resize(found.points.size());
            for (std::size_t i = 0; i < points.size(); ++i)
                points[i].add(found.points[i].deviation_mgal,
                              truth.deviation_mgal(found.points[i].averaging_s));
            const std::array<Limits, 3> found_levels{found.noises.white_mgal_sqrt_s,
                                                     found.noises.flicker_mgal,
                                                     found.noises.walk_mgal_per_sqrt_s};
            const std::array<double, 3> true_levels{truth.white_mgal_sqrt_s.value,
                                                    truth.flicker_mgal.value,
                                                    truth.walk_mgal_per_sqrt_s.value};
            for (std::size_t i = 0; i < 3; ++i) levels[i].add(found_levels[i], true_levels[i]);
        }
        std::printf("%s: deviations", known.name);
        for (const Share& share : points) {
            std::printf(" %.3f", share.value());
            CHECK(share.value() >= (test::is_long() ? 0.91 : 0.85));
            pooled.inside += share.inside;
            pooled.all += share.all;
        }
        std::printf("; white, flicker, walk %.3f %.3f %.3f; described %d of %d\n",
                    levels[0].value(), levels[1].value(), levels[2].value(), described, records);
        for (const Share& share : levels)
            std::printf("    upper limit %.2f times the truth, none in %d of %d\n", share.width,
                        share.unlimited, share.all);
        CHECK(described >= 0.97 * records);
        // A noise without the other two is determined well.
        const std::array<double, 3> truths{known.white, known.flicker, known.walk};
        for (std::size_t i = 0; i < 3; ++i) {
            const bool is_alone = truths[i] > 0.0 && std::ranges::count(truths, 0.0) == 2;
            if (!is_alone) continue;
            CHECK(levels[i].unlimited == 0);
            CHECK(levels[i].width < 1.3);
        }
        for (const Share& share : levels) CHECK(share.value() >= (test::is_long() ? 0.9 : 0.82));
    }
    std::printf("pooled %.4f\n", pooled.value());
    CHECK(std::abs(pooled.value() - 0.95) < (test::is_long() ? 0.01 : 0.025));
}

TEST_CASE("the Allan deviation of several stays, and its limits") {
    // No difference reaches from stay to stay, so their levels have no effect.
    std::vector<std::vector<double>> stays{
        white_noise(200, 1.0, 1), white_noise(120, 1.0, 2), {5.0, 7.0}};
    double squares = 0.0, count = 0.0;
    for (std::size_t k = 0; k < 2; ++k) {
        const auto differences = static_cast<double>(stays[k].size() - 15);
        const double deviation = allan_deviation(stays[k], 8);
        squares += differences * deviation * deviation;
        count += differences;
        for (double& value : stays[k]) value += 1000.0 * static_cast<double>(k + 1);
    }
    const auto pooled = pooled_allan(stays, kStep_s).points;
    REQUIRE(pooled.size() == 6);  // up to 50 samples
    CHECK(pooled[3].deviation_mgal.value == Approx(std::sqrt(squares / count)).epsilon(1e-9));

    const int days = test::is_long() ? 500 : 100;
    Share share;
    for (int day = 0; day < days; ++day) {
        std::vector<std::vector<double>> parts;
        for (std::uint64_t stay = 0; stay < 8; ++stay) {
            const auto seed = 100 * static_cast<std::uint64_t>(day) + stay;
            parts.push_back(white_noise(150 + 30 * stay, 2.0, seed));
            const auto walk = random_walk(parts.back().size(), 0.1, seed);
            for (std::size_t i = 0; i < walk.size(); ++i) parts.back()[i] += walk[i];
        }
        const ThreeNoises truth{{2.0 * std::sqrt(kStep_s)}, {}, {0.1 / std::sqrt(kStep_s)}};
        for (const AllanPoint& point : pooled_allan(parts, kStep_s).points)
            share.add(point.deviation_mgal, truth.deviation_mgal(point.averaging_s));
    }
    std::printf("stays together: %.4f\n", share.value());
    CHECK(std::abs(share.value() - 0.95) < 0.025);
}

TEST_CASE("a cycle of the oven is not taken for noise") {
    std::vector<double> values = white_noise(4000, 0.5, 11);
    CHECK(analyse_allan(values, kStep_s).noises.describes_record);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] += 3.0 * std::sin(2.0 * 3.14159265 * static_cast<double>(i) * kStep_s / 900.0);
    CHECK_FALSE(analyse_allan(values, kStep_s).noises.describes_record);
}
