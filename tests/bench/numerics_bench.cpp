#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "corrector/eemd/eemd.hpp"
#include "corrector/signal/decimation.hpp"

namespace {

using namespace a351::corrector;

std::vector<double> oscillation(std::size_t n) {
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double t = static_cast<double>(i);
        values[i] = std::sin(t / 7.0) + 0.3 * std::sin(t / 1.7) + 1e-4 * t;
    }
    return values;
}

/// Samples, members.  Items are samples x members x modes x sifts, so that the rate is comparable.
void ensemble(benchmark::State& state) {
    const auto signal = oscillation(static_cast<std::size_t>(state.range(0)));
    EemdOptions options;
    options.ensemble_size = static_cast<int>(state.range(1));
    options.finish = FinishRule::always;
    const int modes = default_mode_count(signal.size());
    for (auto _ : state) benchmark::DoNotOptimize(eemd(signal, options));
    state.SetItemsProcessed(state.iterations() * state.range(0) * state.range(1) * modes * 10);
}
BENCHMARK(ensemble)->Args({450, 80})->Args({5400, 160})->Unit(benchmark::kMillisecond);

void decimate_an_hour(benchmark::State& state) {
    const auto signal = oscillation(180000);
    const auto filter = design_decimation(10);
    for (auto _ : state) benchmark::DoNotOptimize(decimate(signal, filter));
    state.SetItemsProcessed(state.iterations() * 180000);
}
BENCHMARK(decimate_an_hour)->Unit(benchmark::kMillisecond);

}  // namespace
