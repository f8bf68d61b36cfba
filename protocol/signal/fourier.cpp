#include "protocol/signal/fourier.hpp"

#include <unsupported/Eigen/FFT>

#include "protocol/signal/moments.hpp"

namespace a351::signal {

std::size_t fast_length(std::size_t n) {
    for (;; ++n) {
        std::size_t rest = n;
        for (const std::size_t factor : {std::size_t{2}, std::size_t{3}, std::size_t{5}})
            while (rest > 1 && rest % factor == 0) rest /= factor;
        if (rest <= 1) return n;
    }
}

Spectrum half_spectrum(std::span<const double> x, std::size_t length) {
    std::vector<double> padded(x.begin(), x.end());
    padded.resize(length, 0.0);
    Eigen::FFT<double> transform;
    transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    Spectrum spectrum;
    transform.fwd(spectrum, padded);
    return spectrum;
}

Spectrum analytic_signal(std::span<const double> x) {
    const std::size_t length = fast_length(x.size());
    Spectrum padded(length);
    const double mean = mean_of(x);
    for (std::size_t i = 0; i < x.size(); ++i) padded[i] = x[i] - mean;
    Eigen::FFT<double> transform;
    Spectrum spectrum;
    transform.fwd(spectrum, padded);
    // Doubles the positive frequencies and removes the negative ones.
    for (std::size_t k = 1; k < (length + 1) / 2; ++k) spectrum[k] *= 2.0;
    for (std::size_t k = length / 2 + 1; k < length; ++k) spectrum[k] = 0.0;
    transform.inv(padded, spectrum);
    padded.resize(x.size());
    return padded;
}

}  // namespace a351::signal
