#include "corrector/eemd/extrema.hpp"

namespace a351::corrector::eemd {
namespace {

/// Calls visit(first, last) for every interior extremum; first and last differ for a plateau.
template <class Visit>
void visit_extrema(std::span<const double> curve, Visit visit) {
    int direction = 0;
    std::size_t level_begin = 0;
    for (std::size_t i = 1; i < curve.size(); ++i) {
        const int step = (curve[i] > curve[i - 1]) - (curve[i] < curve[i - 1]);
        if (step == 0) continue;
        if (step * direction < 0) visit(level_begin, i - 1);
        direction = step;
        level_begin = i;
    }
}

}  // namespace

std::size_t count_extrema(std::span<const double> curve) noexcept {
    std::size_t count = 0;
    visit_extrema(curve, [&](std::size_t, std::size_t) { ++count; });
    return count;
}

std::vector<std::size_t> extremum_indices(std::span<const double> curve) {
    std::vector<std::size_t> indices;
    visit_extrema(
        curve, [&](std::size_t first, std::size_t last) { indices.push_back((first + last) / 2); });
    return indices;
}

}  // namespace a351::corrector::eemd
