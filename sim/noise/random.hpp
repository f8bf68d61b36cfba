#pragma once

#include <cstdint>
#include <string_view>

namespace a351::sim::noise {

/// Reproducible random numbers: one stream per noise source, so that a change of one source does
/// not change the others.  The n-th draw depends on (seed, name, n) only.
///
/// Source: splitmix64, G. L. Steele, D. Lea and C. H. Flood, Fast splittable pseudorandom number
/// generators, OOPSLA 2014, doi:10.1145/2660193.2660195.
class RandomStream {
public:
    RandomStream(std::uint64_t seed, std::string_view name) noexcept;

    [[nodiscard]] std::uint64_t bits() noexcept;

    /// Returns a uniform draw from the open interval (0, 1).
    [[nodiscard]] double uniform() noexcept;
    [[nodiscard]] double uniform(double low, double high) noexcept;

    /// Returns a normal draw with mean 0 and standard deviation 1; uses one draw of bits().
    [[nodiscard]] double normal() noexcept;

    /// Returns an exponential draw with mean 1: the wait until the next event of a Poisson process
    /// of rate 1.
    [[nodiscard]] double exponential() noexcept;

private:
    std::uint64_t state_;
};

/// Returns the inverse of the normal distribution function: the x with Phi(x) = p, for p in (0, 1).
/// Accuracy: relative error below 1e-15 (tests/unit/sim/signal/noise_test.cpp checks 1e-13 against
/// erfc).
/// Source: M. J. Wichura, Algorithm AS 241, Appl. Statist. 37(3), 477-484, 1988, PPND16.
[[nodiscard]] double normal_quantile(double p) noexcept;

}  // namespace a351::sim::noise
