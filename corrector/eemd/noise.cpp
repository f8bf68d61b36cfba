#include "corrector/eemd/noise.hpp"

#include "corrector/eemd/sift_kernels.hpp"

namespace a351::corrector {
namespace {

std::uint32_t low_word(std::uint64_t value) { return static_cast<std::uint32_t>(value); }
std::uint32_t high_word(std::uint64_t value) { return static_cast<std::uint32_t>(value >> 32); }

}  // namespace

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key) noexcept {
    constexpr std::uint64_t kMultiplier0 = 0xD2511F53;
    constexpr std::uint64_t kMultiplier1 = 0xCD9E8D57;
    constexpr std::uint32_t kWeyl0 = 0x9E3779B9;
    constexpr std::uint32_t kWeyl1 = 0xBB67AE85;
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t p0 = kMultiplier0 * counter[0];
        const std::uint64_t p1 = kMultiplier1 * counter[2];
        counter = {high_word(p1) ^ counter[1] ^ key[0], low_word(p1),
                   high_word(p0) ^ counter[3] ^ key[1], low_word(p0)};
        key = {key[0] + kWeyl0, key[1] + kWeyl1};
    }
    return counter;
}

void fill_white_noise(std::uint64_t seed, std::uint64_t member, std::span<double> noise) noexcept {
    fastest_kernels().fill_white_noise(seed, member, noise.data(), noise.size());
}

}  // namespace a351::corrector
