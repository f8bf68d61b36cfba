#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "corrector/reading/smoother.hpp"
#include "protocol/signal/decimator.hpp"

namespace {

using namespace a351;
using namespace a351::corrector::reading;
using namespace a351::signal;

std::vector<double> oscillation(std::size_t n) {
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = std::sin(static_cast<double>(i) / 7.0);
    return values;
}

/// Measures decimation by ten of `range(0)` samples; the time must be linear in their number.
void decimate_series(benchmark::State& state) {
    const auto signal = oscillation(static_cast<std::size_t>(state.range(0)));
    const auto filter = design_decimation(10);
    for (auto _ : state) benchmark::DoNotOptimize(decimate(signal, filter));
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.SetComplexityN(state.range(0));
}
BENCHMARK(decimate_series)
    ->RangeMultiplier(10)
    ->Range(10'000, 10'000'000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);

/// Measures decimation from 50 Hz to 2 s as data arrive, in parts of `range(0)` samples.
void decimate_stream(benchmark::State& state) {
    const auto signal = oscillation(180'000);
    const auto burst = static_cast<std::size_t>(state.range(0));
    for (auto _ : state) {
        Decimator decimator(design_decimation(10), 2);
        std::vector<double> output;
        for (std::size_t i = 0; i + burst <= signal.size(); i += burst) {
            decimator.push(std::span(signal).subspan(i, burst), output);
        }
        decimator.finish(output);
        benchmark::DoNotOptimize(output.data());
    }
    state.SetItemsProcessed(state.iterations() * 180'000);
}
BENCHMARK(decimate_stream)->Arg(1)->Arg(50)->Arg(4096)->Unit(benchmark::kMillisecond);

/// Measures smoothing of `range(0)` samples with standard errors; the time must be linear in their
/// number.
void smooth_series(benchmark::State& state) {
    const auto signal = oscillation(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        const SmoothTrend trend = smooth(signal, 150.0);
        benchmark::DoNotOptimize(trend.standard_errors());
    }
    state.SetComplexityN(state.range(0));
}
BENCHMARK(smooth_series)
    ->RangeMultiplier(10)
    ->Range(450, 450'000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);

}  // namespace
