#pragma once

#include "protocol/core/units.hpp"

namespace a351::sim {

struct TemperatureErrorParameters {
    double reference_degc = 0.0;
    double crystal_static_mgal_per_degc = 0.0;   ///< rA
    double crystal_dynamic_mgal_per_degc = 0.0;  ///< kA
    double crystal_tau_s = 0.0;
    double clock_mgal_per_degc = 0.0;  ///< rC
    double clock_tau_s = 0.0;
    double warm_up_mgal = 0.0;  ///< B
    double warm_up_tau_h = 0.0;
};

/// The four addends of the temperature error.
struct TemperatureErrorTerms {
    double static_mgal = 0.0;
    double dynamic_mgal = 0.0;
    double clock_mgal = 0.0;
    double warm_up_mgal = 0.0;
};

/// What temperature does to the reading, beyond the sensor's own compensation:
///
///     err = rA (Tb - T0) + kA (lag(Tb, tauA) - Tb) + rC (lag(Tb, tauC) - T0) + B exp(-t/tauW)
///
/// lag: first order, y += (1 - exp(-dt/tau)) (x - y), started in equilibrium; t since power-on.
/// The crystals feel a change before the thermometer that compensates them (kA), the oscillator
/// that counts them follows later (rC).  Fitted to the statistics of the published record.
class TemperatureError {
public:
    TemperatureError(const TemperatureErrorParameters& parameters, DegC body, double step_s);

    /// Advances one step to this body temperature.
    [[nodiscard]] MilliGal next(DegC body, double since_power_on_s) noexcept;

    /// Of the last step; next() returned their sum.
    [[nodiscard]] const TemperatureErrorTerms& terms() const noexcept { return terms_; }

private:
    TemperatureErrorParameters p_;
    double crystal_gain_, clock_gain_;
    double crystal_degc_, clock_degc_;  ///< Lagged body temperatures.
    TemperatureErrorTerms terms_;
};

}  // namespace a351::sim
