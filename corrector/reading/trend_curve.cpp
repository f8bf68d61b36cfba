#include "corrector/reading/trend_curve.hpp"

#include <algorithm>
#include <cstddef>

namespace a351::corrector::reading {
namespace {

/// Largest number of extrema of the slow curve.  Reason: the interval needs four, two from either
/// end.  A wave has two per period, so up to three and a half waves in a record count as slow.
constexpr std::size_t kMostExtrema = 7;

}  // namespace

std::vector<double> paper_curve(const eemd::Result& components) {
    const eemd::Component* slowest = nullptr;
    for (const eemd::Component& mode : components.modes) {
        if (std::ranges::all_of(mode.values, [](double value) { return value == 0.0; })) continue;
        if (slowest == nullptr || mode.mean_period_samples >= slowest->mean_period_samples)
            slowest = &mode;
    }
    std::vector<double> curve = components.residue.values;
    if (slowest == nullptr) return curve;
    for (std::size_t i = 0; i < curve.size(); ++i) curve[i] += slowest->values[i];
    return curve;
}

std::vector<double> trend_curve(std::span<const double> signal, const eemd::Options& decomposition,
                                TrendCurve choice) {
    if (choice == TrendCurve::paper) return paper_curve(eemd::eemd(signal, decomposition));
    return eemd::eemd_trend(signal, kMostExtrema, decomposition).values;
}

}  // namespace a351::corrector::reading
