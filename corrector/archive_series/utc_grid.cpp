#include "corrector/archive_series/utc_grid.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>

namespace a351::corrector::archive_series {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr double kZeroCrossings = 32.0;  // Z; 0.64 s at 50 Hz are lost next to a gap
constexpr double kBeta = 10.0;           // b; stop band below -95 dB
// Steps of the kernel table per sample.  Reason: the error of linear interpolation between them is
// (pi / steps)^2 / 8 of a weight, 3e-7.
constexpr int kSteps = 2048;

double kernel(double zero_crossings) {
    static const double at_0 = std::cyl_bessel_i(0.0, kBeta);
    const double x = std::numbers::pi * zero_crossings;
    const double sinc = x == 0.0 ? 1.0 : std::sin(x) / x;
    const double inside = std::max(0.0, 1.0 - std::pow(zero_crossings / kZeroCrossings, 2));
    return sinc * std::cyl_bessel_i(0.0, kBeta * std::sqrt(inside)) / at_0;
}

/// Returns the rate between the starts of records i and i + 1.  In the last record it is that before;
/// in a single one that of the header.
double rate_in_record(const archive::Segment& segment, std::size_t i) {
    const auto& anchors = segment.anchors;
    if (anchors.size() < 2) return segment.rate_hz;
    const auto* anchor = &anchors[std::min(i, anchors.size() - 2)];
    return static_cast<double>(anchor[1].offset - anchor[0].offset) /
           seconds_between(anchor[0].time, anchor[1].time);
}

}  // namespace

UtcTime grid_time(std::int64_t k, int rate_hz) {
    const auto second = std::chrono::floor<std::chrono::seconds>(
        UtcTime(Nanoseconds((k >= 0 ? k : k - rate_hz + 1) / rate_hz * kNanosecondsPerSecond)));
    const std::int64_t rest = k - second.time_since_epoch().count() * rate_hz;
    return second + Nanoseconds(rest * kNanosecondsPerSecond / rate_hz);
}

std::int64_t first_on_grid(UtcTime time, int rate_hz) {
    const auto second = std::chrono::floor<std::chrono::seconds>(time);
    const std::int64_t within = (time - second).count();
    const std::int64_t k =
        second.time_since_epoch().count() * rate_hz + within * rate_hz / kNanosecondsPerSecond;
    return grid_time(k, rate_hz) < time ? k + 1 : k;
}

UtcGrid::UtcGrid(double source_rate_hz, int rate_hz) : rate_hz_(rate_hz) {
    if (rate_hz < 1 || rate_hz > 1.01 * source_rate_hz) {
        throw std::invalid_argument(
            fmt::format("rate_hz = {}; allowed: 1 to the samples' {:f}", rate_hz, source_rate_hz));
    }
    const double scale = std::min(1.0, rate_hz / source_rate_hz);
    half_width_ = kZeroCrossings / scale;
    for (int i = 0; i <= static_cast<int>(std::ceil(half_width_ * kSteps)) + 1; ++i) {
        const double crossings = scale * i / kSteps;
        kernel_.push_back(crossings < kZeroCrossings ? kernel(crossings) : 0.0);
    }
}

GridRun UtcGrid::resample(const archive::Segment& segment, UtcTime from, UtcTime to) const {
    const UtcTime begin = std::max(from, segment.anchors.front().time);
    const UtcTime end = std::min(to, segment.time_of(segment.counts.size() - 1) + Nanoseconds(1));
    GridRun run;
    const auto& anchors = segment.anchors;
    std::size_t record = 0;
    const double last = static_cast<double>(segment.counts.size() - 1) - half_width_;
    for (std::int64_t k = first_on_grid(begin, rate_hz_);; ++k) {
        const UtcTime time = grid_time(k, rate_hz_);
        if (time >= end) break;
        while (record + 1 < anchors.size() && anchors[record + 1].time <= time) ++record;
        const double u =
            static_cast<double>(anchors[record].offset) +
            seconds_between(anchors[record].time, time) * rate_in_record(segment, record);
        if (u < half_width_) continue;
        if (u > last) break;
        if (run.values.empty()) run.first = k;
        run.values.push_back(at(segment.counts, u));
    }
    return run;
}

/// Returns the interpolated value.  The sum is over differences from a neighbour, so that a common
/// level costs no digits.
double UtcGrid::at(const std::vector<std::int32_t>& counts, double position) const {
    const double origin = counts[static_cast<std::size_t>(position)];
    const auto first = static_cast<std::size_t>(std::ceil(position - half_width_));
    const auto last = static_cast<std::size_t>(std::floor(position + half_width_));
    double sum = 0.0;
    double weights = 0.0;
    for (std::size_t j = first; j <= last; ++j) {
        const double step = std::abs(position - static_cast<double>(j)) * kSteps;
        const auto i = static_cast<std::size_t>(step);
        const double weight =
            kernel_[i] + (step - static_cast<double>(i)) * (kernel_[i + 1] - kernel_[i]);
        sum += weight * (counts[j] - origin);
        weights += weight;
    }
    return origin + sum / weights;
}

}  // namespace a351::corrector::archive_series
