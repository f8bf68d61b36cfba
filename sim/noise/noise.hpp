#pragma once
/// @file
/// Slow random parts of the acceleration: one value per step, stationary from the first one on.

#include <vector>

#include "sim/noise/random.hpp"

namespace a351::sim::noise {

/// Flicker noise: power spectrum 1/f between two periods, as the sum of Ornstein-Uhlenbeck
/// processes of equal variance whose time constants are spaced by a factor of two at most.
class FlickerNoise {
public:
    /// @param rms  standard deviation of the stationary process; its unit is that of next().
    FlickerNoise(RandomStream stream, double rms, double shortest_period_s, double longest_period_s,
                 double step_s);

    [[nodiscard]] double next() noexcept;

private:
    struct Part {
        double keep = 0.0;  ///< exp(-step / tau).
        double kick = 0.0;  ///< Standard deviation of the innovation.
        double value = 0.0;
    };
    RandomStream stream_;
    std::vector<Part> parts_;
};

/// A resonance driven by white noise: second-order autoregressive, half-power width f/Q.
class ResonantNoise {
public:
    ResonantNoise(RandomStream stream, double rms, double period_s, double quality, double step_s);

    [[nodiscard]] double next() noexcept;

private:
    RandomStream stream_;
    double first_ = 0.0, second_ = 0.0;  ///< Autoregressive coefficients.
    double kick_ = 0.0;
    double last_ = 0.0, before_ = 0.0;
};

}  // namespace a351::sim::noise
