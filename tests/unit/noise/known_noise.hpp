#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "protocol/signal/fourier.hpp"
#include "sim/noise/random.hpp"
#include "tests/support/catch.hpp"

namespace a351::corrector::noise {

constexpr double kStep_s = 20.0;  ///< Time between samples.

inline std::vector<double> white_noise(std::size_t count, double sd, std::uint64_t seed) {
    sim::noise::RandomStream stream(seed, "white");
    std::vector<double> values(count);
    for (double& value : values) value = sd * stream.normal();
    return values;
}

constexpr std::size_t kFiner = 8;  ///< Steps within a sample, which is their mean.

inline std::vector<double> averaged(const std::vector<double>& fine) {
    std::vector<double> values(fine.size() / kFiner, 0.0);
    for (std::size_t i = 0; i < values.size(); ++i)
        for (std::size_t k = 0; k < kFiner; ++k)
            values[i] += fine[kFiner * i + k] / static_cast<double>(kFiner);
    return values;
}

/// Returns averages of a random walk with the variance `per_sample`^2 in the time of a sample.
inline std::vector<double> random_walk(std::size_t count, double per_sample, std::uint64_t seed) {
    sim::noise::RandomStream stream(seed, "walk");
    std::vector<double> fine(kFiner * count);
    double sum = 0.0;
    for (double& value : fine)
        value = sum += per_sample / std::sqrt(static_cast<double>(kFiner)) * stream.normal();
    return averaged(fine);
}

/// Returns averages of noise with the one-sided density level^2 / (pi f): white noise through the
/// filter (1 - B)^(-1/2), which begins with the record.
/// Source: N. J. Kasdin, Proc. IEEE 83, 802-827, 1995, eq. 104.
inline std::vector<double> flicker_noise(std::size_t count, double level, std::uint64_t seed) {
    // A filter that begins with the record is not stationary; an earlier part is dropped.
    const std::size_t before = 4 * kFiner * count, size = before + kFiner * count;
    sim::noise::RandomStream stream(seed, "flicker");
    std::vector<double> noise(size), filter(size, 1.0);
    // The density of the filtered noise is 2 sd^2 / (2 pi f), whatever the step.
    for (double& value : noise) value = level * stream.normal();
    for (std::size_t k = 1; k < size; ++k)
        filter[k] = filter[k - 1] * (static_cast<double>(k) - 0.5) / static_cast<double>(k);
    const std::size_t length = signal::fast_length(2 * size);
    const signal::Spectrum a = signal::half_spectrum(noise, length),
                           b = signal::half_spectrum(filter, length);
    // The transform back is a transform of the conjugate.
    signal::Spectrum whole(length);
    for (std::size_t k = 0; k < a.size(); ++k) {
        whole[k] = a[k] * b[k];
        if (k > 0 && 2 * k < length) whole[length - k] = std::conj(whole[k]);
    }
    std::vector<double> real(length), imaginary(length);
    for (std::size_t k = 0; k < length; ++k) {
        real[k] = whole[k].real();
        imaginary[k] = whole[k].imag();
    }
    const signal::Spectrum of_real = signal::half_spectrum(real, length),
                           of_imaginary = signal::half_spectrum(imaginary, length);
    std::vector<double> fine(kFiner * count);
    for (std::size_t i = 0; i < fine.size(); ++i) {
        // x_n = 1/N sum X_k e^(+...), and X(-n) is the conjugate's transform.
        const std::size_t n = before + i;
        fine[i] = (of_real[n].real() + of_imaginary[n].imag()) / static_cast<double>(length);
    }
    return averaged(fine);
}

}  // namespace a351::corrector::noise
