#pragma once

#include <array>
#include <cstddef>

#include "daemon/verdict/verdict_options.hpp"

namespace a351::daemon::verdict {

/// A model of the sensor's temperature, in steps of 20 s: a body that relaxes to the level at which
/// oven and air would keep it, plus the oven's cycle.
///
///     dT/dt = (L - T) / relax_min,   dL/dt = R + noise,   dR/dt = -R / 700 s + noise
///     c turns by 2 pi in cycle_s, decays with 2500 s and is driven by noise;   observed: T + c
///
/// A Kalman filter: future values are linear functions of the state, and the covariance gives their
/// errors.
/// Source: R. E. Kalman, J. Basic Eng. 82, 35-45, 1960, doi:10.1115/1.3662552.
class OvenFilter {
public:
    static constexpr double kStepSeconds = 20.0;
    static constexpr std::size_t kStates = 5;
    using State = std::array<double, kStates>;  ///< T, L [degC], R [degC/s], c, quadrature.

    explicit OvenFilter(const Options& options);

    void begin(double degc);                 ///< Starts again at this temperature.
    void step();                             ///< Advances by one time step.
    void see(double degc, double rms_degc);  ///< Takes a mean with its error.
    void touch();                            ///< Notes that the lid may be open from now on.

    [[nodiscard]] const State& state() const noexcept { return state_; }
    /// Returns the state one step later, without noise.
    [[nodiscard]] State ahead(const State& state) const;
    /// Returns the variance of weights . state.
    [[nodiscard]] double variance_of(const State& weights) const;
    /// Returns the variance of the noise of one step.
    [[nodiscard]] double unrest(std::size_t i) const { return unrest_[i * kStates + i]; }
    [[nodiscard]] static double seen(const State& state) { return state[0] + state[3]; }
    [[nodiscard]] double off_level_degc() const { return state_[1] - state_[0]; }  ///< L - T

private:
    using Square = std::array<double, kStates * kStates>;  ///< Stored by columns.

    Square transition_{}, unrest_{}, covariance_{};
    State state_{};
    double lid_degc_, lid_degc_per_s_;
};

}  // namespace a351::daemon::verdict
