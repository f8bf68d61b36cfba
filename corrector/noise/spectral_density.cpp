#include "corrector/noise/spectral_density.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "protocol/signal/fourier.hpp"
#include "protocol/signal/regression.hpp"

namespace a351::corrector::noise {
namespace {

// An eighth of the record gives about 15 segments, limits of about -20 and +35 % of the amplitude, and periods up to a 24th
// of the record.  32 samples leave 13 frequencies.  The straight line takes a part of the power below 3.
constexpr std::size_t kSegments = 8, kShortest = 32, kFirst = 3;

std::size_t segment_length(std::size_t count) {
    std::size_t length = std::max(kShortest, count / kSegments);
    while (length > kShortest && (length % 2 != 0 || signal::fast_length(length) != length))
        --length;
    return length;
}

}  // namespace

std::vector<double> hann(std::size_t n) {
    std::vector<double> window(n);
    for (std::size_t i = 0; i < n; ++i)
        window[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) /
                                         static_cast<double>(n));
    return window;
}

std::vector<Density> spectral_density(const std::vector<double>& values, double step_s) {
    return spectral_density(values, step_s, segment_length(values.size()));
}

std::vector<Density> spectral_density(const std::vector<double>& values, double step_s,
                                      std::size_t length) {
    return pooled_density({values}, step_s, length);
}

std::vector<Density> pooled_density(const std::vector<std::vector<double>>& parts, double step_s,
                                    std::size_t length) {
    const std::vector<double> window = hann(length);
    const double power = std::inner_product(window.begin(), window.end(), window.begin(), 0.0);
    const std::size_t half = length / 2;
    const double overlap = std::inner_product(window.begin() + static_cast<std::ptrdiff_t>(half),
                                              window.end(), window.begin(), 0.0) /
                           power;
    std::vector<double> sums(half + 1, 0.0);
    std::size_t count = 0, pairs = 0;  // of overlapping segments
    for (const std::vector<double>& values : parts)
        for (std::size_t first = 0; first + length <= values.size(); first += half, ++count) {
            std::vector<double> part =
                signal::without_line(std::span(values).subspan(first, length));
            for (std::size_t i = 0; i < length; ++i) part[i] *= window[i];
            const signal::Spectrum spectrum = signal::half_spectrum(part, length);
            for (std::size_t k = 0; k <= half; ++k) sums[k] += std::norm(spectrum[k]);
            pairs += first > 0 ? 1 : 0;
        }
    if (count == 0) return {};
    const auto segments = static_cast<double>(count);
    const double dof =
        2.0 * segments / (1.0 + 2.0 * static_cast<double>(pairs) / segments * overlap * overlap);
    std::vector<Density> densities;
    for (std::size_t k = kFirst; k < half; ++k) {
        densities.push_back({static_cast<double>(k) / (static_cast<double>(length) * step_s),
                             variance_limits(2.0 * step_s * sums[k] / (segments * power), dof)});
    }
    return densities;
}

std::vector<Tile> spectrogram(const std::vector<double>& values, double step_s) {
    constexpr double kHour_s = 3600.0, kBand = 1.189207115;  // 2^(1/4)
    const auto hour = 2 * static_cast<std::size_t>(std::lround(kHour_s / step_s / 2.0));
    const std::size_t hop = std::max(hour, values.size() / kMostColumns);
    const double hop_s = static_cast<double>(hop) * step_s;
    const double bin_hz = 1.0 / (static_cast<double>(hour) * step_s);
    std::vector<Tile> tiles;
    for (std::size_t first = 0; first + 2 * hop <= values.size(); first += hop) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
        const std::vector<Density> densities =
            spectral_density({begin, begin + static_cast<std::ptrdiff_t>(2 * hop)}, step_s, hour);
        const double start_s = static_cast<double>(first) * step_s + 0.5 * hop_s;
        for (auto low = densities.begin(); low != densities.end();) {
            const auto high = std::find_if(low + 1, densities.end(), [&](const Density& one) {
                return one.frequency_hz > kBand * low->frequency_hz;
            });
            double sum = 0.0;
            for (auto one = low; one != high; ++one) sum += one->mgal2_per_hz.value;
            tiles.push_back({start_s, start_s + hop_s, low->frequency_hz - 0.5 * bin_hz,
                             (high - 1)->frequency_hz + 0.5 * bin_hz,
                             sum / static_cast<double>(high - low)});
            low = high;
        }
    }
    return tiles;
}

}  // namespace a351::corrector::noise
