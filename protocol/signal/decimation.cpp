#include "protocol/signal/decimation.hpp"

#include <fmt/core.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "protocol/signal/decimator.hpp"

namespace a351::signal {

DecimationFilter design_decimation(int factor) {
    if (factor < 2 || factor > 1000) {
        throw std::invalid_argument(
            fmt::format("design_decimation: factor = {}, must be 2 to 1000", factor));
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
    for (int n = 0; n <= order; ++n)
        filter.taps.push_back(right[static_cast<std::size_t>(std::abs(n - half))] / sum);
    return filter;
}

double least_length(const DecimationFilter& filter, int stages) {
    const double factor = static_cast<double>(filter.factor);
    const double half_width = static_cast<double>(filter.half_width());
    double first = 0.0;  // index of the first valid value after each stage
    for (int stage = 0; stage < stages; ++stage) first = std::ceil((first + half_width) / factor);
    double last_needed = first;  // back through the stages: index of the last value that it needs
    for (int stage = 0; stage < stages; ++stage) last_needed = factor * last_needed + half_width;
    return last_needed + 1.0;
}

std::vector<double> decimate(std::span<const double> input, const DecimationFilter& filter) {
    std::vector<double> output;
    output.reserve(input.size() / filter.factor + 1);
    Decimator decimator(filter);
    decimator.push(input, output);
    decimator.finish(output);
    return output;
}

}  // namespace a351::signal
