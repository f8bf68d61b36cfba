#pragma once
/// @file
/// A temperature controller and its oven as seen from outside: the values that the panel shows and
/// the values that can be set.  The oven's port uses the plant through this interface only.

#include "protocol/core/units.hpp"

namespace a351::sim::plant {

enum class ControllerKind { pi, on_off };

/// P and I in the terms of a controller: drive = error / band + integral of error / (band time).
struct ControllerTuning {
    double proportional_band_degc = 0.0;  ///< > 0: the error at which P alone gives full drive.
    double integral_time_s = 0.0;         ///< 0: no integral action.
};

class OvenPlant {
public:
    virtual ~OvenPlant() = default;

    /// Returns the thermocouple's temperature in the controller's resolution.  It follows the oven
    /// even while the sensor is set broken.
    [[nodiscard]] virtual DegC controller_reading() const noexcept = 0;
    [[nodiscard]] virtual double drive() const noexcept = 0;  ///< 0 ... 1 of the heater's power.
    [[nodiscard]] virtual DegC set_point() const noexcept = 0;
    [[nodiscard]] virtual bool is_sensor_broken() const noexcept = 0;
    [[nodiscard]] virtual ControllerKind controller() const noexcept = 0;
    [[nodiscard]] virtual ControllerTuning tuning() const noexcept = 0;

    // Each setting takes effect at the plant's next step.
    virtual void set_set_point(DegC set_point) = 0;
    virtual void set_running(bool is_running) = 0;  ///< Stopped: no drive.
    virtual void break_sensor(bool is_broken) = 0;  ///< Broken: no drive.
    virtual void set_controller(ControllerKind kind) = 0;
    virtual void set_tuning(const ControllerTuning& tuning) = 0;
};

}  // namespace a351::sim::plant
