#include "corrector/signal/trend_curve.hpp"

#include <algorithm>
#include <cstddef>

namespace a351::corrector {
namespace {

/// Four extrema are needed for two from either end, and one slow wave has two per period: up to
/// three and a half waves in a record count as slow.
constexpr std::size_t kMostExtrema = 7;

bool is_zero(const Component& mode) {
    return std::all_of(mode.values.begin(), mode.values.end(),
                       [](double value) { return value == 0.0; });
}

/// The mode of the longest mean period among those that are not zero; null without any.
const Component* slowest_mode(const EemdResult& components) {
    const Component* slowest = nullptr;
    for (const Component& mode : components.modes) {
        if (is_zero(mode)) continue;
        if (slowest == nullptr || mode.mean_period_samples >= slowest->mean_period_samples) {
            slowest = &mode;
        }
    }
    return slowest;
}

}  // namespace

std::vector<double> trend_curve(const EemdResult& components, TrendCurve choice) {
    std::vector<double> curve = components.residue.values;
    const Component* const slowest = slowest_mode(components);
    for (const Component& mode : components.modes) {
        const bool is_chosen =
            choice == TrendCurve::paper ? &mode == slowest : mode.extrema_count <= kMostExtrema;
        if (!is_chosen) continue;
        for (std::size_t i = 0; i < curve.size(); ++i) curve[i] += mode.values[i];
    }
    return curve;
}

}  // namespace a351::corrector
