#pragma once

#include <array>
#include <cstddef>

#include "daemon/verdict/verdict_options.hpp"

namespace a351::daemon {

/// What the temperature of the sensor does, from one mean of 20 s to the next: a body that relaxes to
/// the level at which oven and air would keep it, and the oven's cycle upon it.
///
///     dT/dt = (L - T) / relax_min,   dL/dt = R + noise,   dR/dt = -R / 700 s + noise
///     c turns by 2 pi in cycle_s, decays with 2500 s and is kept up by noise;   seen: T + c
///
/// A Kalman filter: what is to come is a linear function of the state, and the covariance says how
/// well that is known.
/// Source: R. E. Kalman, J. Basic Eng. 82, 35-45, 1960, doi:10.1115/1.3662552.
class OvenFilter {
public:
    static constexpr double kStepSeconds = 20.0;
    static constexpr std::size_t kStates = 5;
    using State = std::array<double, kStates>;  ///< T, L [degC], R [degC/s], c, quadrature.

    explicit OvenFilter(const VerdictOptions& options);

    void begin(double degc);                 ///< Nothing else is known.
    void step();                             ///< One step of time.
    void see(double degc, double rms_degc);  ///< A mean with its error.
    void touch();                            ///< The lid may be open from now on.

    [[nodiscard]] const State& state() const noexcept { return state_; }
    [[nodiscard]] State ahead(const State& state) const;  ///< One step later, without the noise.
    [[nodiscard]] double variance_of(const State& weights) const;  ///< Of weights . state
    /// Variance of one step's noise.
    [[nodiscard]] double unrest(std::size_t i) const { return unrest_[i * kStates + i]; }
    [[nodiscard]] static double seen(const State& state) { return state[0] + state[3]; }
    [[nodiscard]] double off_level_degc() const { return state_[1] - state_[0]; }  ///< L - T

private:
    using Square = std::array<double, kStates * kStates>;  ///< By columns.

    Square transition_{}, unrest_{}, covariance_{};
    State state_{};
    double lid_degc_, lid_degc_per_s_;
};

}  // namespace a351::daemon
