#include "sim/plant/temperature_error.hpp"

#include <cmath>

namespace a351::sim::plant {

TemperatureError::TemperatureError(const TemperatureErrorParameters& parameters, DegC body,
                                   double step_s)
    : p_(parameters),
      body_degc_(body.value()),
      crystal_(p_.crystal_tau_s, step_s, body.value()),
      clock_(p_.clock_tau_s, step_s, body.value()) {}

MilliGal TemperatureError::next(DegC body, double since_power_on_s) noexcept {
    const double body_degc = body.value();
    const double crystal_degc = crystal_.next(body_degc_, body_degc);
    const double clock_degc = clock_.next(body_degc_, body_degc);
    body_degc_ = body_degc;
    const double above_degc = body_degc - p_.reference_degc;
    terms_.static_mgal = p_.crystal_static_mgal_per_degc * above_degc +
                         p_.crystal_quadratic_mgal_per_degc2 * above_degc * above_degc;
    terms_.dynamic_mgal = p_.crystal_dynamic_mgal_per_degc * (crystal_degc - body_degc);
    terms_.clock_mgal = p_.clock_mgal_per_degc * (clock_degc - p_.reference_degc);
    terms_.warm_up_mgal =
        p_.warm_up_mgal * std::exp(-since_power_on_s / (3600.0 * p_.warm_up_tau_h));
    return MilliGal(terms_.static_mgal + terms_.dynamic_mgal + terms_.clock_mgal +
                    terms_.warm_up_mgal);
}

}  // namespace a351::sim::plant
