#pragma once

#include "sim/plant/oven_plant.hpp"

namespace a351::sim::oven {

/// An oven without dynamics: it shows the values that a test sets.
class FakeOven final : public plant::OvenPlant {
public:
    DegC reading{42.5};
    double power = 0.25;
    DegC target{42.5};
    bool runs = true;
    bool is_broken = false;
    plant::ControllerKind kind = plant::ControllerKind::pi;
    plant::ControllerTuning pi{5.0, 133.0};
    int set_point_writes = 0;
    int tuning_writes = 0;

    DegC controller_reading() const noexcept override { return reading; }
    double drive() const noexcept override { return runs && !is_broken ? power : 0.0; }
    DegC set_point() const noexcept override { return target; }
    bool is_sensor_broken() const noexcept override { return is_broken; }
    plant::ControllerKind controller() const noexcept override { return kind; }
    plant::ControllerTuning tuning() const noexcept override { return pi; }
    void set_set_point(DegC set_point) override {
        target = set_point;
        ++set_point_writes;
    }
    void set_running(bool is_running) override { runs = is_running; }
    void break_sensor(bool is_now_broken) override { is_broken = is_now_broken; }
    void set_controller(plant::ControllerKind now) override { kind = now; }
    void set_tuning(const plant::ControllerTuning& tuning) override {
        pi = tuning;
        ++tuning_writes;
    }
};

}  // namespace a351::sim::oven
