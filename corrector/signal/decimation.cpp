#include "corrector/signal/decimation.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

namespace a351::corrector {

DecimationFilter design_decimation(int factor) {
    if (factor < 2 || factor > 1000) {
        throw std::invalid_argument("design_decimation: factor = " + std::to_string(factor) +
                                    ", must be 2 to 1000");
    }
    const int order = 8 * factor + 2;
    const int half = order / 2;
    std::vector<double> right(static_cast<std::size_t>(half) + 1);  // h[half], h[half + 1], ...
    double sum = 0.0;
    for (int j = half; j >= 0; --j) {
        const double x = std::numbers::pi * j / factor;
        const double sinc = j == 0 ? 1.0 : std::sin(x) / x;
        const double window = 0.54 - 0.46 * std::cos(2.0 * std::numbers::pi * (half + j) / order);
        right[static_cast<std::size_t>(j)] = sinc * window;
        sum += (j == 0 ? 1.0 : 2.0) * sinc * window;
    }
    DecimationFilter filter;
    filter.factor = static_cast<std::size_t>(factor);
    for (int n = 0; n <= order; ++n) {
        filter.taps.push_back(right[static_cast<std::size_t>(std::abs(n - half))] / sum);
    }
    return filter;
}

std::vector<double> decimate(std::span<const double> input, const DecimationFilter& filter) {
    const std::size_t half = filter.half_width();
    const std::size_t n = input.size();
    std::vector<double> output((n + filter.factor - 1) / filter.factor,
                               std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < output.size(); ++k) {
        const std::size_t centre = k * filter.factor;
        if (centre < half || centre + half >= n) continue;
        // From the outside in: the smallest terms first.  A NaN among the inputs makes the sum NaN.
        double sum = 0.0;
        for (std::size_t j = half; j >= 1; --j) {
            sum += filter.taps[half + j] * (input[centre - j] + input[centre + j]);
        }
        sum += filter.taps[half] * input[centre];
        if (std::isfinite(sum)) output[k] = sum;
    }
    return output;
}

}  // namespace a351::corrector
