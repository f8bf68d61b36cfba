#include "daemon/config/unit_thresholds.hpp"

#include <cmath>

namespace a351::daemon {

VerdictOptions thresholds_for(const corrector::Calibration& unit) {
    VerdictOptions options;
    if (unit.thermal) {
        const auto& values = unit.thermal->values;  // Order: corrector::kThermalNames.
        options.static_mgal_per_degc = values[0];
        options.slow_mgal_per_degc = values[1];
        options.rate_mgal_h_per_degc = values[2];
        options.slow_lag_min = std::exp(values[4]) / 60.0;
    }
    if (unit.warm_up && unit.warm_up->after_power_on_h > 0.0 &&
        unit.warm_up->within_mgal < options.warm_up_mgal) {
        options.warm_up_h = unit.warm_up->after_power_on_h /
                            std::log(options.warm_up_mgal / unit.warm_up->within_mgal);
    }
    return options;
}

}  // namespace a351::daemon
