#pragma once
/// @file
/// Series that several tests decompose.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "corrector/eemd/eemd.hpp"
#include "tests/support/white_noise.hpp"

namespace a351::corrector::eemd {

inline std::vector<double> white_noise(std::size_t n, std::uint64_t seed) {
    std::vector<double> noise(n);
    fill_white_noise(seed, 0, noise);
    return noise;
}

/// Returns a cosine that begins at a phase, in samples.
inline std::vector<double> tone(std::size_t n, double period, double phase = 0.0) {
    std::vector<double> out(n);
    for (std::size_t i = 0; i < n; ++i)
        out[i] = std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + phase) / period);
    return out;
}

/// Returns the options of plain EMD.
inline Options plain() {
    Options options;
    options.noise_ratio = 0.0;
    return options;
}

inline Options small_ensemble(int members = 20) {
    Options options;
    options.ensemble_size = members;
    options.seed = 11;
    return options;
}

/// Returns a drift, a slow and a fast wave, and some noise; of order 1.
inline std::vector<double> mixed_series(std::size_t n) {
    std::vector<double> series = white_noise(n, 7);
    for (std::size_t i = 0; i < n; ++i) {
        const double t = static_cast<double>(i);
        series[i] = 0.3 * series[i] + 1e-3 * t + std::sin(2.0 * std::numbers::pi * t / 97.0) +
                    0.5 * std::cos(2.0 * std::numbers::pi * t / 11.0);
    }
    return series;
}

/// Returns all components, the residue last.
inline std::vector<std::vector<double>> components_of(const Result& result) {
    std::vector<std::vector<double>> all;
    for (const Component& mode : result.modes) all.push_back(mode.values);
    all.push_back(result.residue.values);
    return all;
}

inline double rms(std::span<const double> values) {
    double squares = 0.0;
    for (const double value : values) squares += value * value;
    return std::sqrt(squares / static_cast<double>(values.size()));
}

inline double largest_magnitude(std::span<const double> values) {
    double largest = 0.0;
    for (const double value : values) largest = std::max(largest, std::abs(value));
    return largest;
}

/// Returns the signal minus the sum of the components.
inline std::vector<double> closure(std::span<const double> signal, const Result& result) {
    std::vector<double> rest(signal.begin(), signal.end());
    for (const auto& component : components_of(result))
        for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= component[i];
    return rest;
}

/// Returns the largest magnitude of the signal minus the sum of the components.
inline double closure_error(std::span<const double> signal, const Result& result) {
    return largest_magnitude(closure(signal, result));
}

}  // namespace a351::corrector::eemd
