#include "corrector/noise/record_noise.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/signal/regression.hpp"

namespace a351::corrector::noise {
namespace {

/// Ratio to the least scatter below which an average is as good.
constexpr double kHardlyMore = 1.1;

/// Returns the rms difference of averages over `samples` that begin `apart` samples from each other,
/// divided by sqrt(2).
double scatter_apart(const std::vector<double>& values, std::size_t samples, std::size_t apart) {
    std::vector<double> sums(values.size() + 1, 0.0);
    const double mean = signal::mean_of(values);
    for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i] - mean;
    const std::size_t count = values.size() - apart - samples + 1;
    double squares = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double change =
            (sums[i + apart + samples] - sums[i + apart] - sums[i + samples] + sums[i]) /
            static_cast<double>(samples);
        squares += change * change;
    }
    return std::sqrt(0.5 * squares / static_cast<double>(count));
}

}  // namespace

RecordNoise record_noise(const std::vector<double>& values, double step_s) {
    RecordNoise noise{spectral_density(values, step_s), analyse_allan(values, step_s), {}, {}};
    const auto apart = static_cast<std::size_t>(std::lround(kBetweenStays_s / step_s));
    if (values.size() < 3 * apart) return noise;
    for (std::size_t samples = 1; samples <= apart; samples *= 2)
        noise.stays.push_back(
            {static_cast<double>(samples) * step_s, scatter_apart(values, samples, apart)});
    const double least_mgal =
        std::ranges::min_element(noise.stays, {}, &StayScatter::scatter_mgal)->scatter_mgal;
    noise.useful = *std::ranges::find_if(noise.stays, [&](const StayScatter& stay) {
        return stay.scatter_mgal <= kHardlyMore * least_mgal;
    });
    return noise;
}

}  // namespace a351::corrector::noise
