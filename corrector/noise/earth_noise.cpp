#include "corrector/noise/earth_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace a351::corrector::noise {
namespace {

/// A part of a model: level of the power in dB of 1 (m/s^2)^2/Hz, a + b lg T from this period on.
struct Part {
    double period_s, a, b;
};

// clang-format off
constexpr std::array<Part, 21> kLow{{
    {0.10, -162.36, 5.64},    {0.17, -166.70, 0.00},    {0.40, -170.00, -8.30},  {0.80, -166.40, 28.90},
    {1.24, -168.60, 52.48},   {2.40, -159.98, 29.81},   {4.30, -141.10, 0.00},   {5.00, -71.36, -99.77},
    {6.00, -97.26, -66.49},   {10.00, -132.18, -31.57}, {12.00, -205.27, 36.16}, {15.60, -37.65, -104.33},
    {21.90, -114.37, -47.10}, {31.60, -160.58, -16.28}, {45.00, -187.50, 0.00},  {70.00, -216.47, 15.70},
    {101.00, -185.00, 0.00},  {154.00, -168.34, -7.61}, {328.00, -217.43, 11.90}, {600.00, -258.28, 26.60},
    {10000.0, -346.88, 48.75}}};
constexpr std::array<Part, 11> kHigh{{
    {0.10, -108.73, -17.23}, {0.22, -150.34, -80.50}, {0.32, -122.31, -23.87}, {0.80, -116.85, 32.51},
    {3.80, -108.48, 18.08},  {4.60, -74.66, -32.95},  {6.30, 0.66, -127.18},   {7.90, -93.37, -22.42},
    {15.40, 73.54, -162.98}, {20.00, -151.52, 10.01}, {354.80, -206.66, 31.63}}};
// clang-format on
constexpr double kLongest_s = 100'000.0, kMgalPerMeterPerSecondSquared = 1e5;

}  // namespace

double ground_noise_mgal_per_sqrt_hz(GroundNoise model, double period_s) {
    const std::span<const Part> parts =
        model == GroundNoise::low ? std::span<const Part>(kLow) : std::span<const Part>(kHigh);
    if (!(period_s >= parts.front().period_s && period_s <= kLongest_s))
        return std::numeric_limits<double>::quiet_NaN();
    const Part& part = *std::prev(std::ranges::upper_bound(parts, period_s, {}, &Part::period_s));
    return kMgalPerMeterPerSecondSquared *
           std::pow(10.0, (part.a + part.b * std::log10(period_s)) / 20.0);
}

}  // namespace a351::corrector::noise
