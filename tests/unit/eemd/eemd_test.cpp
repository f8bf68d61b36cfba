#include "corrector/eemd/eemd.hpp"

#include "tests/support/catch.hpp"

#include "tests/unit/eemd/series.hpp"

namespace a351::corrector::eemd {

TEST_CASE("results are bit-identical on any number of threads and in every run") {
    const std::vector<double> signal = mixed_series(450);
    Options options = small_ensemble(37);
    const Result one = eemd(signal, options);
    for (const int threads : {1, 2, 3, 8, 100}) {
        options.threads = threads;
        const Result many = eemd(signal, options);
        CHECK(components_of(many) == components_of(one));
        for (std::size_t k = 0; k < one.modes.size(); ++k)
            CHECK(many.modes[k].standard_error == one.modes[k].standard_error);
    }
}

TEST_CASE("the signal minus the sum of the components is the mean of the added noise") {
    const std::vector<double> signal = mixed_series(450);
    const Options options = small_ensemble(20);
    const Result result = eemd(signal, options);
    std::vector<double> mean_noise(signal.size());
    std::vector<double> noise(signal.size());
    for (std::uint64_t member = 0; member < 20; ++member) {
        fill_white_noise(options.seed, member, noise);
        for (std::size_t i = 0; i < noise.size(); ++i) mean_noise[i] += noise[i] / 20.0;
    }
    const auto left_over = closure(signal, result);
    for (std::size_t i = 0; i < signal.size(); ++i)
        REQUIRE(left_over[i] == Approx(-result.noise_level * mean_noise[i]).margin(1e-13));
}

TEST_CASE("the remaining noise falls with the square root of the ensemble size") {
    // n samples determine an rms to one part in sqrt(2 n); three times that and more is allowed.
    for (const auto& [n, members, margin] :
         {std::tuple(128U, 1000, 3.0 / 16.0), {5400U, 16, 0.05}}) {
        const std::vector<double> signal = mixed_series(n);
        const Result result = eemd(signal, small_ensemble(members));
        CHECK(rms(closure(signal, result)) * std::sqrt(members) / result.noise_level ==
              Approx(1.0).margin(margin));
    }
}

TEST_CASE("the noise level is the ratio times the standard deviation of the signal") {
    Options options = small_ensemble(1);
    options.noise_ratio = 0.5;
    const std::vector<double> signal = {1.0, 2.0, 3.0, 4.0};
    CHECK(eemd(signal, options).noise_level == Approx(0.5 * std::sqrt(5.0 / 3.0)));
}

TEST_CASE("neighbouring seeds give uncorrelated noise") {
    const std::vector<double> signal = mixed_series(1000);
    Options options = small_ensemble(16);
    const auto first = closure(signal, eemd(signal, options));
    ++options.seed;
    const auto second = closure(signal, eemd(signal, options));
    double product = 0.0;
    for (std::size_t i = 0; i < first.size(); ++i) product += first[i] * second[i];
    const double correlation =
        product / (rms(first) * rms(second) * static_cast<double>(first.size()));
    CHECK(std::abs(correlation) < 4.0 / std::sqrt(1000.0));
}

TEST_CASE("components scale with the unit of the signal, for powers of two bit for bit") {
    const std::vector<double> signal = mixed_series(300);
    const auto unit = components_of(eemd(signal, small_ensemble()));
    for (const double factor : {0x1p-40, 0x1p40, 0x1p-900, 0x1p900}) {
        std::vector<double> scaled = signal;
        for (double& value : scaled) value *= factor;
        auto components = components_of(eemd(scaled, small_ensemble()));
        for (auto& component : components)
            for (double& value : component) value /= factor;
        CHECK(components == unit);
    }
    for (const double factor : {1e-12, 1e12}) {
        std::vector<double> scaled = signal;
        for (double& value : scaled) value *= factor;
        const auto components = components_of(eemd(scaled, small_ensemble()));
        for (std::size_t k = 0; k < unit.size(); ++k)
            for (std::size_t i = 0; i < signal.size(); ++i)
                REQUIRE(components[k][i] / factor == Approx(unit[k][i]).margin(1e-8));
    }
}

TEST_CASE("the stated standard error is the scatter of repeated ensembles") {
    const std::vector<double> signal = mixed_series(300);
    const int runs = 40;
    std::vector<std::vector<double>> sum, squares;
    double stated = 0.0;
    Options options = small_ensemble(16);
    options.complementary_pairs = GENERATE(false, true);
    for (int run = 0; run < runs; ++run) {
        options.seed = 100 + static_cast<std::uint64_t>(run);
        const Result result = eemd(signal, options);
        const auto components = components_of(result);
        sum.resize(components.size(), std::vector<double>(300));
        squares.resize(components.size(), std::vector<double>(300));
        for (std::size_t k = 0; k < components.size(); ++k)
            for (std::size_t i = 0; i < 300; ++i) {
                sum[k][i] += components[k][i];
                squares[k][i] += components[k][i] * components[k][i];
            }
        for (const Component& mode : result.modes)
            stated += *mode.standard_error * *mode.standard_error / runs;
        stated += *result.residue.standard_error * *result.residue.standard_error / runs;
    }
    double found = 0.0;
    for (std::size_t k = 0; k < sum.size(); ++k)
        for (std::size_t i = 0; i < 300; ++i)
            found += (squares[k][i] - sum[k][i] * sum[k][i] / runs) / (runs - 1) / 300.0;
    // The scatter of 40 runs of correlated samples is itself known to about a tenth.
    CHECK(std::sqrt(stated / found) == Approx(1.0).margin(0.2));
}

TEST_CASE("the standard error falls with the noise, down to the rounding of the sums of squares") {
    const std::vector<double> signal = mixed_series(300);
    Options options = small_ensemble(16);
    options.noise_ratio = 1e-5;
    const Result faint = eemd(signal, options);
    options.noise_ratio = 1e-6;
    const Result fainter = eemd(signal, options);
    CHECK(*fainter.modes[0].standard_error ==
          Approx(0.1 * *faint.modes[0].standard_error).epsilon(0.05));
    options.noise_ratio = 1e-12;
    const Result nothing = eemd(signal, options);
    for (const Component& mode : nothing.modes) {
        const double rounding = 1e-7 / std::sqrt(16.0) * rms(mode.values);
        CHECK(*mode.standard_error >= 0.99 * rounding);
        CHECK(*mode.standard_error <= 1.5 * rounding);
    }
}

TEST_CASE("with complementary pairs the components add up to the signal") {
    const std::vector<double> signal = mixed_series(450);
    Options options = small_ensemble(20);
    options.complementary_pairs = true;
    const Result result = eemd(signal, options);
    CHECK(result.noise_level > 0.01);
    CHECK(closure_error(signal, result) <= 1e-12 * rms(signal));
}

TEST_CASE("with complementary pairs an inverted signal has inverted components, bit for bit") {
    std::vector<double> signal = mixed_series(450);
    Options options = small_ensemble(10);
    options.complementary_pairs = true;
    const Result upright = eemd(signal, options);
    for (double& value : signal) value = -value;
    const Result flipped = eemd(signal, options);
    for (std::size_t k = 0; k < upright.modes.size(); ++k) {
        CHECK(flipped.modes[k].standard_error == upright.modes[k].standard_error);
        for (std::size_t i = 0; i < signal.size(); ++i)
            REQUIRE(flipped.modes[k].values[i] == -upright.modes[k].values[i]);
    }
}

TEST_CASE("a constant added to a signal appears only in the residue") {
    const Options options = GENERATE(plain(), small_ensemble());
    std::vector<double> signal = mixed_series(450);
    const auto before = components_of(eemd(signal, options));
    for (double& value : signal) value += 1024.0;
    const auto after = components_of(eemd(signal, options));
    REQUIRE(after.size() == before.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
        const double offset = k + 1 == before.size() ? 1024.0 : 0.0;
        for (std::size_t i = 0; i < signal.size(); ++i)
            REQUIRE(after[k][i] - offset == Approx(before[k][i]).margin(1e-9));
    }
}

TEST_CASE("energy shares add up to one and are in the ratio of the components' variances") {
    std::vector<double> signal = mixed_series(450);
    for (double& value : signal) value += 1e6;
    const Result result = eemd(signal, small_ensemble());
    double total = result.residue.energy_share;
    for (const Component& mode : result.modes) total += mode.energy_share;
    CHECK(total == Approx(1.0));
    const double ratio = rms(result.modes[1].values) / rms(result.modes[0].values);
    CHECK(result.modes[1].energy_share / result.modes[0].energy_share ==
          Approx(ratio * ratio).epsilon(1e-3));  // the small means of the modes are neglected
    CHECK(eemd(std::vector<double>(64, 2.0)).residue.energy_share == 0.0);
}

TEST_CASE("the components of a record with reflected ends have the length of the record") {
    const std::vector<double> signal = mixed_series(451);
    Options options = small_ensemble();
    options.reflect_ends = true;
    options.complementary_pairs = true;
    for (const std::size_t n : {0U, 1U, 2U, 3U, 4U, 451U}) {
        const std::vector<double> part(signal.begin(), signal.begin() + static_cast<long>(n));
        options.mode_count = 3;
        const Result result = eemd(part, options);
        for (const auto& component : components_of(result)) CHECK(component.size() == n);
        CHECK(closure_error(part, result) <= 1e-12);
    }
    // A cosine reflected at its extrema continues unchanged: one mode with equal extrema.
    const std::vector<double> cosine = tone(401, 40.0);
    options.noise_ratio = 0.0;
    const Result result = eemd(cosine, options);
    for (std::size_t i = 0; i < 401; ++i)
        REQUIRE(result.modes[0].values[i] == Approx(cosine[i]).margin(1e-12));
}

TEST_CASE("progress counts up to all members, and its exception ends the decomposition") {
    const std::vector<double> signal = mixed_series(200);
    for (const int threads : {1, 3}) {
        Options options = small_ensemble(50);
        options.threads = threads;
        std::vector<std::size_t> steps;
        options.progress = [&](std::size_t done, std::size_t members) {
            CHECK(members == 50);
            steps.push_back(done);
        };
        const auto watched = components_of(eemd(signal, options));
        CHECK(std::is_sorted(steps.begin(), steps.end()));
        CHECK(steps.back() == 50);
        options.progress = nullptr;
        CHECK(components_of(eemd(signal, options)) == watched);
        options.progress = [](std::size_t, std::size_t) { throw std::runtime_error("stop"); };
        CHECK_THROWS_WITH(eemd(signal, options), "stop");
    }
}

TEST_CASE("an option outside its range is refused by name") {
    const std::vector<double> signal(16, 1.0);
    const auto refused = [&](const std::string& name, void (*change)(Options&)) {
        Options options;
        change(options);
        CHECK_THROWS_WITH(eemd(signal, options), ContainsSubstring(name));
        CHECK_THROWS_AS(eemd(signal, options), std::invalid_argument);
    };
    refused("ensemble_size = 0", [](Options& of) { of.ensemble_size = 0; });
    refused("ensemble_size = 9", [](Options& of) {
        of.ensemble_size = 9;
        of.complementary_pairs = true;
    });
    refused("noise_ratio", [](Options& of) { of.noise_ratio = -0.1; });
    refused("mode_count = -1", [](Options& of) { of.mode_count = -1; });
    refused("threads = 0", [](Options& of) { of.threads = 0; });
    refused("stopping.count = 0", [](Options& of) { of.stopping = FixedSifts{0}; });
    refused("stopping.count = 10001", [](Options& of) { of.stopping = FixedSifts{10001}; });
    refused("stopping.repeats = 0", [](Options& of) { of.stopping = SNumber{0}; });
}

}  // namespace a351::corrector::eemd
