#include "corrector/eemd/extrema.hpp"

namespace a351::corrector::eemd {

std::size_t count_extrema(std::span<const double> curve) { return extremum_indices(curve).size(); }

std::vector<std::size_t> extremum_indices(std::span<const double> curve) {
    std::vector<std::size_t> indices;
    int direction = 0;
    std::size_t level_begin = 0;
    for (std::size_t i = 1; i < curve.size(); ++i) {
        const int step = (curve[i] > curve[i - 1]) - (curve[i] < curve[i - 1]);
        if (step == 0) continue;
        if (step * direction < 0) indices.push_back((level_begin + i - 1) / 2);
        direction = step;
        level_begin = i;
    }
    return indices;
}

}  // namespace a351::corrector::eemd
