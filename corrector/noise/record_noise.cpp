#include "corrector/noise/record_noise.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/signal/regression.hpp"

namespace a351::corrector::noise {
namespace {

/// Ratio to the least scatter below which an average is as good.
constexpr double kHardlyMore = 1.1;

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
