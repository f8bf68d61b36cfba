#pragma once

#include <optional>

#include "sim/plant/thermal_plant.hpp"

namespace a351::sim::plant {

/// The oven, and around it an outer one if the box has two.
///
/// The air around the inner oven is the body of the outer one, and the heat that the inner oven
/// loses warms this body.  The heater of the outer oven is its wall.  Each oven has a controller,
/// and so a cycle, of its own.
class Ovens {
public:
    /// Both start in equilibrium with `ambient` and run in, as long as the longer of their times.
    Ovens(const OvenParameters& inner, const std::optional<OvenParameters>& outer, DegC ambient);

    /// Advances by one step; `ambient` is the air around the outermost oven.
    void step(DegC ambient);

    [[nodiscard]] ThermalPlant& inner() noexcept { return inner_; }
    [[nodiscard]] const ThermalPlant& inner() const noexcept { return inner_; }
    /// Returns the outer oven; null if there is none.
    [[nodiscard]] ThermalPlant* outer() noexcept { return outer_ ? &*outer_ : nullptr; }
    [[nodiscard]] const ThermalPlant* outer() const noexcept { return outer_ ? &*outer_ : nullptr; }

private:
    std::optional<ThermalPlant> outer_;
    ThermalPlant inner_;
};

}  // namespace a351::sim::plant
