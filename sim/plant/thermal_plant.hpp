#pragma once
/// @file
/// The oven in its cool box as two heat capacities and an integrating controller that sees the
/// temperature in coarse steps: its limit cycle is the temperature oscillation of the published
/// record (about 15 min, 0.02 degC; Matsuda et al., tests/golden/tsukuba/README.md).

#include <vector>

#include "protocol/core/units.hpp"

namespace a351::sim {

struct OvenParameters {
    double heater_capacity_j_per_k = 0.0;
    double body_capacity_j_per_k = 0.0;
    double heater_body_k_per_w = 0.0;
    double heater_ambient_k_per_w = 0.0;
    double body_ambient_k_per_w = 0.0;
    double self_heating_w = 0.0;  ///< Of the powered sensor.
    double heater_power_w = 0.0;  ///< At full drive.
    double thermocouple_tau_s = 0.0;
    double dead_time_s = 0.0;
    double set_point_degc = 0.0;
    double resolution_degc = 0.0;
    double proportional_per_degc = 0.0;
    double integral_per_degc_s = 0.0;
};

/// Explicit Euler, step 1 s:
///
///     Ch dTh/dt = q - (Th - Tb)/Rhb - (Th - a)/Rha
///     Cb dTb/dt = (Th - Tb)/Rhb - (Tb - a)/Rba + Pself
///     dTc/dt    = (Th - Tc)/tau_c,   m = Tc(t - t_dead) rounded to the resolution
///     e = set point - m,   I <- clip(I + Ki e dt, 0, 1),   q = Pmax clip(I + Kp e, 0, 1)
class ThermalPlant {
public:
    static constexpr double kStepSeconds = 1.0;

    /// Starts in equilibrium with `ambient`, but for the heater, which is one step of the controller
    /// too warm: exactly in equilibrium the controller would see no error and never begin to cycle.
    ThermalPlant(const OvenParameters& parameters, DegC ambient);

    /// Advances by one step at this temperature of the air around the oven.
    void step(DegC ambient);

    [[nodiscard]] DegC body() const noexcept { return DegC(body_degc_); }
    [[nodiscard]] DegC heater() const noexcept { return DegC(heater_degc_); }
    [[nodiscard]] DegC controller_reading() const noexcept { return DegC(reading_degc_); }
    [[nodiscard]] double drive() const noexcept { return drive_; }  ///< 0 ... 1.

private:
    OvenParameters p_;
    double heater_degc_;
    double body_degc_;
    double thermocouple_degc_;
    double integral_;
    double reading_degc_;
    double drive_;
    std::vector<double> delay_line_degc_;  ///< Thermocouple, one value per step of dead time.
    std::size_t oldest_ = 0;
};

}  // namespace a351::sim
