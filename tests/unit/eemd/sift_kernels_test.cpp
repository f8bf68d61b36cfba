/// @file
/// The kernels of all instruction sets give the same bits.

#include "corrector/eemd/sift_kernels.hpp"

#include <bit>
#include "tests/support/catch.hpp"

#include "corrector/eemd/emd.hpp"
#include "corrector/eemd/ensemble.hpp"
#include "tests/unit/eemd/series.hpp"

namespace a351::corrector::eemd {
namespace {

std::vector<std::uint64_t> bits(std::span<const double> values) {
    std::vector<std::uint64_t> out;
    for (const double value : values) out.push_back(std::bit_cast<std::uint64_t>(value));
    return out;
}

/// Returns all kernels except the portable loops; warns if there are no others.
std::vector<const SiftKernels*> faster_kernels() {
    std::vector<const SiftKernels*> kernels = available_kernels();
    kernels.erase(kernels.begin());
    if (kernels.empty()) WARN("only the portable loops: nothing to compare on this processor");
    return kernels;
}

/// Returns the bits of every mode and of the residue.
std::vector<std::vector<std::uint64_t>> decompose(std::span<const double> signal,
                                                  const SiftOptions& options,
                                                  const SiftKernels& kernels) {
    EmdWorkspace emd(signal.size(), kernels);
    std::copy(signal.begin(), signal.end(), emd.residue().begin());
    std::vector<std::vector<std::uint64_t>> all;
    for (int k = 0; k < 6; ++k) all.push_back(bits(emd.next_mode(options)));
    all.push_back(bits(emd.residue()));
    return all;
}

}  // namespace

TEST_CASE("every instruction set gives the same modes, bit for bit") {
    const std::vector<const SiftKernels*> faster = faster_kernels();
    for (const EndRule ends : {EndRule::line, EndRule::mirror}) {
        SiftOptions options;
        options.finish = FinishRule::always;
        options.ends = ends;
        for (std::size_t n = 1; n < 400; n += n < 70 ? 1 : 37) {
            std::vector<double> signal = white_noise(n, n);
            for (double& value : signal)
                if (n % 3 == 0) value = std::round(value);  // plateaus
            const auto portable = decompose(signal, options, portable_kernels());
            for (const SiftKernels* const kernels : faster) {
                INFO(kernels->name << ", " << n << " samples");
                CHECK(decompose(signal, options, *kernels) == portable);
            }
        }
    }
}

TEST_CASE("every instruction set gives the same ensemble, bit for bit") {
    const std::vector<double> signal = mixed_series(1201);
    EnsemblePlan plan;
    plan.signal = signal;
    plan.noise_level = 0.1;
    plan.members = 9;
    plan.mode_count = 9;
    plan.kernels = &portable_kernels();
    const EnsembleSums portable = sum_ensemble(plan, 1, {});
    for (const SiftKernels* const kernels : faster_kernels()) {
        INFO(kernels->name);
        plan.kernels = kernels;
        const EnsembleSums sums = sum_ensemble(plan, 1, {});
        CHECK(bits(sums.values) == bits(portable.values));
        CHECK(bits(sums.squares) == bits(portable.squares));
    }
}

TEST_CASE("results are bit-identical in every build") {
    // The signal uses no sine of the platform's library, only exact steps and the generator's own
    // noise.
    std::vector<double> signal = white_noise(777, 5);
    for (std::size_t i = 0; i < signal.size(); ++i)
        signal[i] += 0.01 * static_cast<double>(i) + 0.5 * static_cast<double>(i % 31);
    Options options;
    options.ensemble_size = 12;
    options.seed = 4;
    std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a over 64-bit words
    for (const auto& component : components_of(eemd(signal, options)))
        for (const std::uint64_t word : bits(component)) hash = (hash ^ word) * 0x100000001b3;
    CHECK(hash == 0xc7fb613011f73776);
}

}  // namespace a351::corrector::eemd
