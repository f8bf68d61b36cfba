#pragma once

#include "protocol/core/units.hpp"
#include "sim/plant/lag.hpp"

namespace a351::sim::plant {

struct TemperatureErrorParameters {
    double reference_degc = 0.0;
    double crystal_static_mgal_per_degc = 0.0;      ///< rA
    double crystal_quadratic_mgal_per_degc2 = 0.0;  ///< qA
    double crystal_dynamic_mgal_per_degc = 0.0;     ///< kA
    double crystal_tau_s = 0.0;
    double clock_mgal_per_degc = 0.0;  ///< rC
    double clock_tau_s = 0.0;
    double warm_up_mgal = 0.0;  ///< B
    double warm_up_tau_h = 0.0;
};

/// The four terms of the temperature error.
struct TemperatureErrorTerms {
    double static_mgal = 0.0;
    double dynamic_mgal = 0.0;
    double clock_mgal = 0.0;
    double warm_up_mgal = 0.0;
};

/// Effect of temperature on the reading that remains after the sensor's own compensation:
///
///     err = rA (Tb - T0) + qA (Tb - T0)^2 + kA (lag(Tb, tauA) - Tb) + rC (lag(Tb, tauC) - T0) + B exp(-t/tauW)
///
/// lag is first order and starts in equilibrium (Lag).  Tb is the temperature of the body, t the time since power-on.
/// The crystals respond to a change before the thermometer that compensates them (kA).  The
/// oscillator that counts them responds later (rC).  The coefficients are fitted to the statistics
/// of the published record.
class TemperatureError {
public:
    TemperatureError(const TemperatureErrorParameters& parameters, DegC body, double step_s);

    /// Advances one step to this body temperature and returns the error there.
    [[nodiscard]] MilliGal next(DegC body, double since_power_on_s) noexcept;

    /// Returns the terms of the last step; next() returned their sum.
    [[nodiscard]] const TemperatureErrorTerms& terms() const noexcept { return terms_; }

private:
    TemperatureErrorParameters p_;
    double body_degc_;  ///< Body at the last step.
    Lag crystal_, clock_;
    TemperatureErrorTerms terms_;
};

}  // namespace a351::sim::plant
