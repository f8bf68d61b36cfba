#include "protocol/signal/tap_pairs.hpp"

#include <cstring>

namespace a351::signal {
namespace {

/// Sums pairs of taps with explicit vectors, because g++ 12 unrolls the plain loop before it could
/// vectorise it.
template <std::size_t kLanes>
[[gnu::always_inline]] inline void sum_tap_pairs(std::span<const TapPair> pairs,
                                                 const double* samples, double* sums) noexcept {
    using Lanes [[gnu::vector_size(kLanes * sizeof(double))]] = double;
    Lanes totals[kSideBySide / kLanes] = {};
    for (const TapPair& pair : pairs) {
        const double* left = samples + pair.left;
        const double* right = samples + pair.right;
        for (Lanes& total : totals) {
            Lanes a;
            Lanes b;
            std::memcpy(&a, left, sizeof a);
            std::memcpy(&b, right, sizeof b);
            total += pair.tap * (a + b);
            left += kLanes;
            right += kLanes;
        }
    }
    std::memcpy(sums, totals, sizeof totals);
}

void with_two_lanes(std::span<const TapPair> pairs, const double* samples, double* sums) noexcept {
    sum_tap_pairs<2>(pairs, samples, sums);
}

#ifdef __x86_64__
[[gnu::target("avx2")]] void with_four_lanes(std::span<const TapPair> pairs, const double* samples,
                                             double* sums) noexcept {
    sum_tap_pairs<4>(pairs, samples, sums);
}
#endif

}  // namespace

std::vector<SumTapPairs> sum_tap_pairs_variants() {
    std::vector<SumTapPairs> variants{with_two_lanes};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2")) variants.push_back(with_four_lanes);
#endif
    return variants;
}

}  // namespace a351::signal
