/// @file
/// Properties that decompositions of noise, tones and bursts must have, with the sources of the
/// figures.

#include <array>
#include "tests/support/catch.hpp"

#include "tests/unit/eemd/series.hpp"

namespace a351::corrector::eemd {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

std::vector<double> sum(std::vector<double> a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
    return a;
}

/// Returns the rms difference, without a tenth of the record at each end.
double inner_difference(const std::vector<double>& a, const std::vector<double>& b) {
    const std::size_t margin = a.size() / 10;
    std::vector<double> difference;
    for (std::size_t i = margin; i < a.size() - margin; ++i) difference.push_back(a[i] - b[i]);
    return rms(difference);
}

}  // namespace

TEST_CASE("ten sifts of white noise act like a bank of octave filters") {
    // P. Flandrin, G. Rilling and P. Goncalves, IEEE Signal Process. Lett. 11, 112-114, 2004; Z. Wu
    // and N. E. Huang, Proc. R. Soc. A 460, 1597-1611, 2004.  The limits hold for ten sifts, 8192
    // samples and geometric means over 40 records; energy times period is nearly constant.
    constexpr int kRecords = 40;
    std::array<double, 9> log_period{};
    std::array<double, 9> log_energy{};
    for (std::uint64_t record = 0; record < kRecords; ++record) {
        const auto result = eemd(white_noise(8192, 50 + record), plain());
        for (std::size_t k = 0; k < 9; ++k) {
            log_period[k] += std::log(result.modes[k].mean_period_samples) / kRecords;
            log_energy[k] += 2.0 * std::log(rms(result.modes[k].values)) / kRecords;
        }
    }
    CHECK(std::exp(log_period[0]) == Approx(2.87).margin(0.03));
    for (std::size_t k = 1; k < 9; ++k) {
        INFO("mode " << k + 1);
        const double ratio = std::exp(log_period[k] - log_period[k - 1]);
        CHECK(ratio > 1.93);
        CHECK(ratio < 2.13);
    }
    double least = HUGE_VAL;
    double most = -HUGE_VAL;
    for (std::size_t k = 1; k < 8; ++k) {
        least = std::min(least, log_energy[k] + log_period[k]);
        most = std::max(most, log_energy[k] + log_period[k]);
    }
    CHECK(std::exp(most - least) < 1.6);
}

TEST_CASE("a pure tone stays in one mode") {
    for (const double period : {7.3, 16.0, 61.7}) {
        const auto signal = tone(2000, period);
        const auto result = eemd(signal, plain());
        INFO("period " << period);
        // Half a sample beside an extremum the tone is lower by 1 - cos(pi / period).
        CHECK(inner_difference(result.modes[0].values, signal) <
              1.0 - std::cos(0.5 * kTurn / period));
        CHECK(result.modes[0].energy_share > 0.99);
        CHECK(result.modes[0].mean_period_samples == Approx(period).epsilon(period / 2000.0));
    }
}

TEST_CASE("tones an octave and a half apart separate, a sixth of an octave apart they do not") {
    // G. Rilling and P. Flandrin, IEEE Trans. Signal Process. 56, 85-95, 2008: ratios of frequency
    // below 0.5 separate, above 0.75 one mode holds the beat.
    const auto fast = tone(2000, 16.0);
    const auto slow = tone(2000, 45.0);
    const auto apart = eemd(sum(fast, slow), plain());
    CHECK(inner_difference(apart.modes[0].values, fast) < 0.02);
    CHECK(inner_difference(apart.modes[1].values, slow) < 0.02);
    const auto beat = sum(fast, tone(2000, 18.0));
    CHECK(inner_difference(eemd(beat, plain()).modes[0].values, beat) < 0.1);
}

TEST_CASE("an ensemble separates a burst from the wave it rides on, plain EMD mixes them") {
    // The example of Z. Wu and N. E. Huang, 2009, section 2: an intermittent fast wave.
    const std::size_t n = 2048;
    auto signal = tone(n, 128.0);
    std::vector<double> burst(n);
    for (std::size_t i = 900; i < 1100; ++i)
        burst[i] = 0.2 * std::sin(kTurn * static_cast<double>(i) / 8.0);
    signal = sum(signal, burst);
    const auto before_burst = [](const std::vector<double>& values) {
        return rms(std::span(values).subspan(205, 600));
    };
    CHECK(before_burst(eemd(signal, plain()).modes[0].values) > 0.5);  // the slow wave has 0.7

    Options options;
    options.noise_ratio = 0.2;
    options.ensemble_size = 200;
    std::vector<double> fast(n);
    for (const Component& mode : eemd(signal, options).modes)
        if (mode.mean_period_samples < 32.0) fast = sum(fast, mode.values);
    CHECK(before_burst(fast) < 0.05);
    CHECK(inner_difference(fast, burst) < 0.3 * rms(std::span(burst).subspan(900, 200)));
}

TEST_CASE("a short record reversed in time has its first mode reversed, with every end rule") {
    // Records are short, so that their modes have few extrema.
    for (const EndRule ends : {EndRule::line, EndRule::mirror}) {
        for (std::size_t n = 8; n <= 40; ++n) {
            for (std::uint64_t seed = 0; seed < 50; ++seed) {
                SiftOptions options;
                options.stopping = FixedSifts{1};  // each sift amplifies rounding
                options.ends = ends;
                std::vector<double> signal = white_noise(n, seed);
                // The mean of three samples leaves waves of five samples and longer.
                for (std::size_t i = 0; i + 2 < n && seed % 2 == 1; ++i)
                    signal[i] = signal[i] + signal[i + 1] + signal[i + 2];
                const auto first_mode = [&] {
                    EmdWorkspace emd(n);
                    std::copy(signal.begin(), signal.end(), emd.residue().begin());
                    const auto mode = emd.next_mode(options);
                    return std::vector<double>(mode.begin(), mode.end());
                };
                const std::vector<double> forward = first_mode();
                std::reverse(signal.begin(), signal.end());
                std::vector<double> backward = first_mode();
                std::reverse(backward.begin(), backward.end());
                INFO(n << " samples, seed " << seed << ", ends " << static_cast<int>(ends));
                REQUIRE(backward.size() == forward.size());
                const double limit = 1e-11 * largest_magnitude(forward);
                for (std::size_t i = 0; i < forward.size(); ++i)
                    REQUIRE(std::abs(backward[i] - forward[i]) <= limit);
            }
        }
    }
}

TEST_CASE("no component grows far beyond the range of the record at its ends") {
    for (const EndRule ends : {EndRule::line, EndRule::mirror}) {
        for (std::uint64_t seed = 0; seed < 20; ++seed) {
            auto signal = white_noise(450, seed);
            for (std::size_t i = 0; i < signal.size(); ++i)
                signal[i] += 1e-2 * static_cast<double>(i);
            const auto [low, high] = std::minmax_element(signal.begin(), signal.end());
            Options options = plain();
            options.ends = ends;
            for (const auto& component : components_of(eemd(signal, options)))
                CHECK(largest_magnitude(component) < 3.0 * (*high - *low));
        }
    }
}

}  // namespace a351::corrector::eemd
