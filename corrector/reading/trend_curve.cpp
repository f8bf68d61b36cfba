#include "corrector/reading/trend_curve.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace a351::corrector {
namespace {

/// Largest number of extrema of the slow curve.  Reason: the interval needs four, two from either
/// end.  A wave has two per period, so up to three and a half waves in a record count as slow.
constexpr std::size_t kMostExtrema = 7;

bool is_zero(const Component& mode) {
    return std::all_of(mode.values.begin(), mode.values.end(),
                       [](double value) { return value == 0.0; });
}

/// Returns the mode of the longest mean period among those that are not zero; nullptr if all are
/// zero.
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

std::vector<double> paper_curve(const EemdResult& components) {
    std::vector<double> curve = components.residue.values;
    const Component* const slowest = slowest_mode(components);
    if (slowest == nullptr) return curve;
    for (std::size_t i = 0; i < curve.size(); ++i) curve[i] += slowest->values[i];
    return curve;
}

Trend trend_curve(std::span<const double> signal, const EemdOptions& decomposition,
                  TrendCurve choice) {
    if (choice == TrendCurve::paper) {
        const EemdResult components = eemd(signal, decomposition);
        return {paper_curve(components), components.noise_level};
    }
    EemdTrend trend = eemd_trend(signal, kMostExtrema, decomposition);
    return {std::move(trend.values), trend.noise_level};
}

}  // namespace a351::corrector
