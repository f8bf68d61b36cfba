#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace a351::corrector {

/// Standard deviation of Gaussian noise over its median absolute deviation.
inline constexpr double kGaussianPerMad = 1.4826;

/// The middle value; the upper of the two middle ones for an even number.
/// @param values  not empty, finite.
[[nodiscard]] inline double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace a351::corrector
