#include "sim/plant/ovens.hpp"

#include <algorithm>
#include <cmath>

namespace a351::sim::plant {

Ovens::Ovens(const OvenParameters& inner, const std::optional<OvenParameters>& outer, DegC ambient)
    : outer_(outer ? std::optional<ThermalPlant>(std::in_place, *outer, ambient) : std::nullopt),
      inner_(inner, outer_ ? outer_->body() : ambient) {
    const double run_in_h = std::max(inner.run_in_h, outer ? outer->run_in_h : 0.0);
    const auto steps = std::llround(3600.0 * run_in_h / ThermalPlant::kStepSeconds);
    for (long long i = 0; i < steps; ++i) step(ambient);
}

void Ovens::step(DegC ambient) {
    if (outer_) {
        outer_->step(ambient, inner_.loss_w(outer_->body()));
        inner_.step(outer_->body());
    } else {
        inner_.step(ambient);
    }
}

}  // namespace a351::sim::plant
