#include "corrector/reading/disturbance.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "protocol/signal/median.hpp"

namespace a351::corrector::reading {
namespace {

/// Samples on either side of the centre of the running median; 61 in all.
constexpr std::size_t kHalfWindow = 30;

double median_of(std::span<const double> values) {
    return signal::median(std::vector<double>(values.begin(), values.end()));
}

/// Returns the slope per sample: the median over all pairs of samples half the length apart.
double median_slope(std::span<const double> series) {
    const std::size_t half = series.size() / 2;
    std::vector<double> slopes;
    for (std::size_t j = 0; j + half < series.size(); ++j)
        slopes.push_back((series[j + half] - series[j]) / static_cast<double>(half));
    return half == 0 ? 0.0 : signal::median(std::move(slopes));
}

/// Returns the line through the first sample with the slope of the whole series.  Without it a
/// running median would follow every sample where the slope per sample is larger than the noise.
std::vector<double> line_through(std::span<const double> series) {
    const double slope = median_slope(series);
    std::vector<double> line;
    for (std::size_t i = 0; i < series.size(); ++i)
        line.push_back(series[0] + slope * static_cast<double>(i));
    return line;
}

std::vector<double> running_median(std::span<const double> series) {
    const std::size_t n = series.size();
    const std::size_t half = std::min(kHalfWindow, (n - 1) / 2);
    std::vector<double> baseline(series.begin(), series.end());
    if (half == 0) return baseline;
    const std::size_t width = 2 * half + 1;
    for (std::size_t i = half; i + half < n; ++i)
        baseline[i] = median_of(series.subspan(i - half, width));
    const double first_slope = median_slope(series.first(width));
    const double last_slope = median_slope(series.last(width));
    const std::size_t last_centre = n - 1 - half;
    for (std::size_t j = 1; j <= half; ++j) {
        const double distance = static_cast<double>(j);
        baseline[half - j] = baseline[half] - distance * first_slope;
        baseline[last_centre + j] = baseline[last_centre] + distance * last_slope;
    }
    return baseline;
}

}  // namespace

Disturbances find_disturbances(std::span<const double> series, double threshold) {
    if (series.empty()) return {};
    const std::size_t n = series.size();
    std::vector<double> baseline = line_through(series);
    std::vector<double> level(n);
    double largest = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        level[i] = series[i] - baseline[i];
        largest = std::max(largest, std::abs(series[i]));
    }
    const std::vector<double> middle = running_median(level);
    std::vector<double> deviation(n);
    for (std::size_t i = 0; i < n; ++i) {
        deviation[i] = level[i] - middle[i];
        baseline[i] += middle[i];
    }
    const double centre = signal::median(deviation);
    std::vector<double> magnitude(n);
    for (std::size_t i = 0; i < n; ++i) magnitude[i] = std::abs(deviation[i] - centre);
    const double limit =
        std::max(threshold * signal::kGaussianPerMad * signal::median(std::move(magnitude)),
                 kSampleRounding * largest);
    std::vector<bool> disturbed(n);
    for (std::size_t i = 0; i < n; ++i) disturbed[i] = std::abs(deviation[i]) > limit;
    return {std::move(disturbed), std::move(baseline)};
}

std::vector<double> despike(std::span<const double> series, const Disturbances& found) {
    assert(found.disturbed.size() == series.size());
    std::vector<double> samples(series.begin(), series.end());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (found.disturbed[i]) samples[i] = found.baseline[i];
    }
    return samples;
}

std::vector<std::vector<double>> quiet_parts(std::span<const double> series, double threshold,
                                             std::size_t shortest) {
    std::vector<std::vector<double>> parts;
    std::vector<double> part;
    const auto end_part = [&] {
        if (part.size() >= shortest) parts.push_back(part);
        part.clear();
    };
    for (std::size_t first = 0, end = 0; first < series.size(); first = end + 1) {
        for (end = first; end < series.size() && !std::isnan(series[end]);) ++end;
        const std::span<const double> run = series.subspan(first, end - first);
        const Disturbances found = find_disturbances(run, threshold);
        for (std::size_t i = 0; i < run.size(); ++i) {
            if (found.disturbed[i])
                end_part();
            else
                part.push_back(run[i]);
        }
        end_part();
    }
    return parts;
}

}  // namespace a351::corrector::reading
