#include "sim/noise/noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace a351::sim::noise {
namespace {

/// Run-in of a resonance, in time constants Q P / pi: enough to forget the start for any Q used
/// here.
constexpr double kSettlingTimeConstants = 8.0;

}  // namespace

FlickerNoise::FlickerNoise(RandomStream stream, double rms, double shortest_period_s,
                           double longest_period_s, double step_s)
    : stream_(stream) {
    const double octaves = std::log2(longest_period_s / shortest_period_s);
    const int intervals = std::max(1, static_cast<int>(std::ceil(octaves)));
    const double part_rms = rms / std::sqrt(intervals + 1.0);
    for (int i = 0; i <= intervals; ++i) {
        const double period_s = shortest_period_s * std::pow(2.0, octaves * i / intervals);
        const double tau_s = period_s / (2.0 * std::numbers::pi);
        Part part;
        part.keep = std::exp(-step_s / tau_s);
        part.kick = part_rms * std::sqrt(1.0 - part.keep * part.keep);
        part.value = part_rms * stream_.normal();
        parts_.push_back(part);
    }
}

double FlickerNoise::next() noexcept {
    double sum = 0.0;
    for (Part& part : parts_) {
        sum += part.value;
        part.value = part.keep * part.value + part.kick * stream_.normal();
    }
    return sum;
}

ResonantNoise::ResonantNoise(RandomStream stream, double rms, double period_s, double quality,
                             double step_s)
    : stream_(stream) {
    const double tau_s = quality * period_s / std::numbers::pi;
    const double radius = std::exp(-step_s / tau_s);
    first_ = 2.0 * radius * std::cos(2.0 * std::numbers::pi * step_s / period_s);
    second_ = -radius * radius;
    // Variance of an AR(2) process: G. E. P. Box and G. M. Jenkins, Time Series Analysis, 3.2.
    const double gain =
        (1.0 - second_) / ((1.0 + second_) * ((1.0 - second_) * (1.0 - second_) - first_ * first_));
    kick_ = rms / std::sqrt(gain);
    const int settling_steps = static_cast<int>(kSettlingTimeConstants * tau_s / step_s);
    if (kick_ > 0.0) {
        for (int i = 0; i < settling_steps; ++i) static_cast<void>(next());
    }
}

double ResonantNoise::next() noexcept {
    const double value = first_ * last_ + second_ * before_ + kick_ * stream_.normal();
    before_ = last_;
    last_ = value;
    return value;
}

}  // namespace a351::sim::noise
