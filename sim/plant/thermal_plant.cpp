#include "sim/plant/thermal_plant.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace a351::sim::plant {

ThermalPlant::ThermalPlant(const OvenParameters& parameters, DegC ambient)
    : p_(parameters), heater_degc_(p_.set_point_degc), thermocouple_degc_(p_.set_point_degc) {
    const double a = ambient.value();
    body_degc_ =
        (heater_degc_ / p_.heater_body_k_per_w + a / p_.body_ambient_k_per_w + p_.self_heating_w) /
        (1.0 / p_.heater_body_k_per_w + 1.0 / p_.body_ambient_k_per_w);
    const double loss_w = (heater_degc_ - body_degc_) / p_.heater_body_k_per_w +
                          (heater_degc_ - a) / p_.heater_ambient_k_per_w;
    integral_ = std::clamp(loss_w / p_.heater_power_w, 0.0, 1.0);
    drive_ = integral_;
    reading_degc_ = p_.set_point_degc;
    heater_degc_ += p_.resolution_degc;
    const double steps = std::round(p_.dead_time_s / kStepSeconds);
    delay_line_degc_.assign(static_cast<std::size_t>(std::max(1.0, steps)), thermocouple_degc_);
}

ControllerTuning ThermalPlant::tuning() const noexcept {
    ControllerTuning tuning;
    if (p_.proportional_per_degc > 0.0)
        tuning.proportional_band_degc = 1.0 / p_.proportional_per_degc;
    if (p_.integral_per_degc_s > 0.0)
        tuning.integral_time_s = p_.proportional_per_degc / p_.integral_per_degc_s;
    return tuning;
}

void ThermalPlant::set_tuning(const ControllerTuning& tuning) {
    p_.proportional_per_degc = 1.0 / tuning.proportional_band_degc;
    p_.integral_per_degc_s =
        tuning.integral_time_s > 0.0 ? p_.proportional_per_degc / tuning.integral_time_s : 0.0;
}

double ThermalPlant::next_drive() {
    const double error = p_.set_point_degc - reading_degc_;
    if (!is_running_ || is_sensor_broken_) return 0.0;
    if (p_.controller == ControllerKind::on_off) {
        // If the set point lies between two steps, some readings leave the drive unchanged.
        const double rounding_degc = 1e-6 * p_.resolution_degc;
        if (error > p_.resolution_degc - rounding_degc) return 1.0;
        return error < rounding_degc ? 0.0 : std::round(drive_);
    }
    integral_ = std::clamp(integral_ + p_.integral_per_degc_s * error * kStepSeconds, 0.0, 1.0);
    return std::clamp(integral_ + p_.proportional_per_degc * error, 0.0, 1.0);
}

double ThermalPlant::loss_w(DegC ambient) const noexcept {
    return (heater_degc_ - ambient.value()) / p_.heater_ambient_k_per_w +
           (body_degc_ - ambient.value()) / p_.body_ambient_k_per_w;
}

void ThermalPlant::step(DegC ambient, double heat_w) {
    constexpr double dt = kStepSeconds;
    const double delayed_degc = std::exchange(delay_line_degc_[oldest_], thermocouple_degc_);
    oldest_ = (oldest_ + 1) % delay_line_degc_.size();
    reading_degc_ = std::round(delayed_degc / p_.resolution_degc) * p_.resolution_degc;
    drive_ = next_drive();

    const double a = ambient.value();
    const double to_body_w = (heater_degc_ - body_degc_) / p_.heater_body_k_per_w;
    const double heater_w =
        p_.heater_power_w * drive_ - to_body_w - (heater_degc_ - a) / p_.heater_ambient_k_per_w;
    const double body_w =
        to_body_w - (body_degc_ - a) / p_.body_ambient_k_per_w + p_.self_heating_w + heat_w;
    thermocouple_degc_ += dt * (heater_degc_ - thermocouple_degc_) / p_.thermocouple_tau_s;
    heater_degc_ += dt * heater_w / p_.heater_capacity_j_per_k;
    body_degc_ += dt * body_w / p_.body_capacity_j_per_k;
}

}  // namespace a351::sim::plant
