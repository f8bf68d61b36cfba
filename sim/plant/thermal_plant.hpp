#pragma once
/// @file
/// The oven in its cool box: two heat capacities and an integrating controller that reads the
/// temperature in coarse steps.  Its limit cycle reproduces the temperature oscillation of the
/// published record (about 15 min, 0.02 degC; Matsuda et al., tests/golden/tsukuba/README.md).

#include <vector>

#include "protocol/core/units.hpp"
#include "sim/plant/oven_plant.hpp"

namespace a351::sim::plant {

struct OvenParameters {
    double heater_capacity_j_per_k = 0.0;
    double body_capacity_j_per_k = 0.0;
    double heater_body_k_per_w = 0.0;
    double heater_ambient_k_per_w = 0.0;
    double body_ambient_k_per_w = 0.0;
    double self_heating_w = 0.0;  ///< Heat from the powered sensor.
    double heater_power_w = 0.0;  ///< At full drive.
    double thermocouple_tau_s = 0.0;
    double dead_time_s = 0.0;
    double set_point_degc = 0.0;
    double resolution_degc = 0.0;
    double proportional_per_degc = 0.0;
    double integral_per_degc_s = 0.0;
    double run_in_h = 0.0;  ///< Running time before the start of a record.
    ControllerKind controller = ControllerKind::pi;
};

/// Explicit Euler, step 1 s:
///
///     Ch dTh/dt = q - (Th - Tb)/Rhb - (Th - a)/Rha
///     Cb dTb/dt = (Th - Tb)/Rhb - (Tb - a)/Rba + Pself
///     dTc/dt    = (Th - Tc)/tau_c,   m = Tc(t - t_dead) rounded to the resolution
///     e = set point - m,   I <- clip(I + Ki e dt, 0, 1),   q = Pmax clip(I + Kp e, 0, 1)
///
/// On/off control: full drive at e >= one step of the resolution, no drive at e <= 0, otherwise
/// as before.  If it is stopped or its sensor is broken, the controller gives q = 0 and keeps I.
class ThermalPlant final : public OvenPlant {
public:
    static constexpr double kStepSeconds = 1.0;

    /// Starts in equilibrium with `ambient`, except that the heater is warmer by one step of the
    /// resolution: in exact equilibrium the controller would see no error and never begin to cycle.
    ThermalPlant(const OvenParameters& parameters, DegC ambient);

    /// Advances by one step.
    /// @param ambient  air around the oven.
    /// @param heat_w   heat from what is inside, added to that of the sensor.
    void step(DegC ambient, double heat_w = 0.0);

    /// Returns the heat that heater and body lose to this air, W.
    [[nodiscard]] double loss_w(DegC ambient) const noexcept;

    [[nodiscard]] DegC body() const noexcept { return DegC(body_degc_); }
    [[nodiscard]] DegC heater() const noexcept { return DegC(heater_degc_); }

    [[nodiscard]] DegC controller_reading() const noexcept override { return DegC(reading_degc_); }
    [[nodiscard]] double drive() const noexcept override { return drive_; }
    [[nodiscard]] DegC set_point() const noexcept override { return DegC(p_.set_point_degc); }
    [[nodiscard]] bool is_sensor_broken() const noexcept override { return is_sensor_broken_; }
    [[nodiscard]] ControllerKind controller() const noexcept override { return p_.controller; }
    [[nodiscard]] ControllerTuning tuning() const noexcept override;
    void set_set_point(DegC set_point) override { p_.set_point_degc = set_point.value(); }
    void set_running(bool is_running) override { is_running_ = is_running; }
    void break_sensor(bool is_broken) override { is_sensor_broken_ = is_broken; }
    void set_controller(ControllerKind kind) override { p_.controller = kind; }
    void set_tuning(const ControllerTuning& tuning) override;

private:
    [[nodiscard]] double next_drive();

    OvenParameters p_;
    double heater_degc_;
    double body_degc_;
    double thermocouple_degc_;
    double integral_;
    double reading_degc_;
    double drive_;
    std::vector<double> delay_line_degc_;  ///< Thermocouple: one value per step of dead time.
    std::size_t oldest_ = 0;
    bool is_running_ = true;
    bool is_sensor_broken_ = false;
};

}  // namespace a351::sim::plant
