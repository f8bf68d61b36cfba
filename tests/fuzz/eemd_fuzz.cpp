/// @file
/// EEMD with any options and any record.  The result must be finite and its components must add up
/// to the record, or std::invalid_argument is thrown.  The loops of every instruction set must give
/// the same bits.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "corrector/eemd/eemd.hpp"
#include "corrector/eemd/ensemble.hpp"
#include "tests/unit/eemd/series.hpp"

namespace {

using namespace a351::corrector;
using namespace a351;
using namespace a351::corrector::eemd;

constexpr std::size_t kOptionBytes = 8;

void require(bool holds) {
    if (!holds) std::abort();
}

/// Returns samples of `width` bytes: one or two bytes give plateaus, eight bytes any value of a
/// double.
std::vector<double> samples(const std::uint8_t* data, std::size_t size, unsigned width) {
    std::vector<double> values;
    for (std::size_t i = 0; i + width <= size; i += width) {
        double value = 0.0;
        if (width == sizeof value) {
            std::memcpy(&value, data + i, sizeof value);
        } else {
            std::int16_t counts = static_cast<std::int8_t>(data[i]);
            if (width == 2) std::memcpy(&counts, data + i, sizeof counts);
            value = counts;
        }
        values.push_back(value);
    }
    return values;
}

eemd::Options options_from(const std::uint8_t* bytes) {
    eemd::Options options;
    options.ensemble_size = bytes[0] % 12;
    options.noise_ratio = bytes[1] % 4 * 0.1;
    options.complementary_pairs = bytes[1] >= 128;
    if (bytes[2] % 2 == 0) {
        options.stopping = FixedSifts{bytes[2] / 8};
    } else {
        options.stopping = SNumber{bytes[2] / 32};
    }
    options.mode_count = bytes[3] % 12;
    options.finish = bytes[4] % 2 == 0 ? FinishRule::at_most_two_extrema : FinishRule::always;
    options.ends = bytes[4] / 2 % 2 == 0 ? EndRule::line : EndRule::mirror;
    options.reflect_ends = bytes[5] >= 128;
    options.seed = bytes[6];
    return options;
}

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

void compare_kernels(const std::vector<double>& signal, const eemd::Options& options) {
    EnsemblePlan plan;
    plan.signal = signal;
    plan.mode_count = static_cast<std::size_t>(*options.mode_count);
    plan.sifting = {options.stopping, options.finish, options.ends};
    plan.kernels = &portable_kernels();
    const auto portable = sum_ensemble(plan, 1, {});
    for (const SiftKernels* const kernels : available_kernels()) {
        plan.kernels = kernels;
        const auto sums = sum_ensemble(plan, 1, {});
        for (std::size_t i = 0; i < sums.values.size(); ++i) {
            require(bits(sums.values[i]) == bits(portable.values[i]));
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < kOptionBytes) return 0;
    const eemd::Options options = options_from(data);
    constexpr unsigned kWidths[] = {1, 2, 8};
    const auto signal = samples(data + kOptionBytes, size - kOptionBytes, kWidths[data[7] % 3]);
    double largest = 0.0;
    try {
        const eemd::Result result = eemd::eemd(signal, options);
        const auto check = [&](const Component& component) {
            require(component.values.size() == signal.size());
            for (const double value : component.values) {
                require(std::isfinite(value));
                largest = std::max(largest, std::abs(value));
            }
        };
        for (const Component& mode : result.modes) check(mode);
        check(result.residue);
        // The noise never exceeds 8.6 standard deviations; 1e-322 allows for coarse rounding of
        // subnormals.
        require(closure_error(signal, result) <=
                9.0 * result.noise_level + 1e-10 * largest + 1e-322);
    } catch (const std::invalid_argument&) {
        return 0;
    }
    if (largest < 1e100) compare_kernels(signal, options);
    return 0;
}
