#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <thread>
#include <vector>

#include "corrector/eemd/eemd.hpp"
#include "corrector/eemd/ensemble.hpp"
#include "protocol/signal/decimation.hpp"
#include "tests/support/white_noise.hpp"

namespace {

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::eemd;
using namespace a351::signal;

std::vector<double> oscillation(std::size_t n) {
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double t = static_cast<double>(i);
        values[i] = std::sin(t / 7.0) + 0.3 * std::sin(t / 1.7) + 1e-4 * t;
    }
    return values;
}

std::vector<double> noisy_oscillation(std::size_t n) {
    std::vector<double> values(n);
    fill_white_noise(1, 0, values);
    const std::vector<double> clean = oscillation(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = clean[i] + 0.3 * values[i];
    return values;
}

/// Returns the number of modes.  Components with the residue are floor(log2 n), as in libeemd, and
/// 11 for 5400 samples, as in the publication.
int modes_for(std::size_t n) { return n == 5400 ? 10 : default_mode_count(n); }

eemd::Options options_for(const benchmark::State& state) {
    eemd::Options options;
    options.ensemble_size = static_cast<int>(state.range(1));
    options.mode_count = modes_for(static_cast<std::size_t>(state.range(0)));
    options.finish = FinishRule::always;
    return options;
}

/// Adds a counter of the time per sample and sift; each mode has ten sifts.
void count_sifts(benchmark::State& state) {
    const double sifts = 10.0 * static_cast<double>(state.range(0) * state.range(1)) *
                         modes_for(static_cast<std::size_t>(state.range(0)));
    state.counters["per_sample_and_sift"] = benchmark::Counter(
        sifts, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Measures an ensemble.  Arguments: samples, members.
void ensemble(benchmark::State& state) {
    const auto signal = noisy_oscillation(static_cast<std::size_t>(state.range(0)));
    const eemd::Options options = options_for(state);
    for (auto _ : state) benchmark::DoNotOptimize(eemd::eemd(signal, options));
    count_sifts(state);
}
BENCHMARK(ensemble)
    ->Args({450, 80})
    ->Args({5400, 160})
    ->Args({65536, 100})
    ->Unit(benchmark::kMillisecond);

/// Returns the series of an occupation: drift, a wave with a period of a quarter of an hour, white
/// noise half as large.
std::vector<double> occupation_series() {
    std::vector<double> values(450);
    fill_white_noise(1, 0, values);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double t = static_cast<double>(i);
        values[i] = 0.5 * values[i] + std::sin(t / 70.0) + 0.003 * t;
    }
    return values;
}

eemd::Options occupation_options() {
    eemd::Options options;
    options.ends = EndRule::mirror;
    return options;
}

/// Measures the part of the decomposition that a survey needs; trend_of_all_modes measures the
/// whole.
void trend_alone(benchmark::State& state) {
    const auto signal = occupation_series();
    const eemd::Options options = occupation_options();
    for (auto _ : state) benchmark::DoNotOptimize(eemd_trend(signal, 7, options));
    state.counters["modes"] = eemd_trend(signal, 7, options).removed_modes;
}
BENCHMARK(trend_alone)->Unit(benchmark::kMillisecond);

void trend_of_all_modes(benchmark::State& state) {
    const auto signal = occupation_series();
    const eemd::Options options = occupation_options();
    for (auto _ : state) benchmark::DoNotOptimize(eemd::eemd(signal, options));
}
BENCHMARK(trend_of_all_modes)->Unit(benchmark::kMillisecond);

void ensemble_threads(benchmark::State& state) {
    const auto signal = noisy_oscillation(5400);
    eemd::Options options;
    options.ensemble_size = 160;
    options.threads = static_cast<int>(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(eemd::eemd(signal, options));
}
BENCHMARK(ensemble_threads)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Measures an ensemble with libeemd's stopping rule: S-number 4, at most 50 sifts.
void ensemble_s4(benchmark::State& state) {
    const auto signal = noisy_oscillation(static_cast<std::size_t>(state.range(0)));
    eemd::Options options = options_for(state);
    options.stopping = SNumber{4};
    for (auto _ : state) benchmark::DoNotOptimize(eemd::eemd(signal, options));
}
BENCHMARK(ensemble_s4)
    ->Args({450, 80})
    ->Args({5400, 160})
    ->Args({65536, 100})
    ->Unit(benchmark::kMillisecond);

/// Measures the loops of one instruction set: 0 the portable ones, then in the order of
/// available_kernels().
void ensemble_kernels(benchmark::State& state) {
    const auto available = available_kernels();
    const auto index = static_cast<std::size_t>(state.range(2));
    if (index >= available.size()) {
        state.SkipWithError("not on this processor");
        return;
    }
    const auto signal = noisy_oscillation(static_cast<std::size_t>(state.range(0)));
    EnsemblePlan plan;
    plan.signal = signal;
    plan.noise_level = 0.1;
    plan.members = static_cast<int>(state.range(1));
    plan.mode_count = static_cast<std::size_t>(modes_for(signal.size()));
    plan.sifting.finish = FinishRule::always;
    plan.kernels = available[index];
    state.SetLabel(plan.kernels->name);
    for (auto _ : state) benchmark::DoNotOptimize(sum_ensemble(plan, 1, {}));
    count_sifts(state);
}
BENCHMARK(ensemble_kernels)
    ->Args({5400, 40, 0})
    ->Args({5400, 40, 1})
    ->Args({5400, 40, 2})
    ->Unit(benchmark::kMillisecond);

/// Measures the largest gain of a second thread on this machine: chains of products without memory
/// access.
void arithmetic(benchmark::State& state) {
    const auto work = [] {
        double a = 1.0, b = 1.0, c = 1.0, d = 1.0;
        for (int i = 0; i < 20'000'000; ++i) {
            a *= 0.9999999;
            b *= 0.9999998;
            c *= 0.9999997;
            d *= 0.9999996;
        }
        benchmark::DoNotOptimize(a + b + c + d);
    };
    // Two halves of the same work, one after the other or at the same time.
    for (auto _ : state) {
        std::jthread other(state.range(0) == 2 ? std::jthread(work) : std::jthread());
        if (state.range(0) == 1) work();
        work();
    }
}
BENCHMARK(arithmetic)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void decimate_an_hour(benchmark::State& state) {
    const auto signal = oscillation(180000);
    const auto filter = design_decimation(10);
    for (auto _ : state) benchmark::DoNotOptimize(decimate(signal, filter));
    state.SetItemsProcessed(state.iterations() * 180000);
}
BENCHMARK(decimate_an_hour)->Unit(benchmark::kMillisecond);

}  // namespace
