#include "daemon/config/verdict_config.hpp"

#include <cmath>

namespace a351::daemon {
namespace {

/// A key and its plausible range; a value outside is a typing error.
struct Key {
    const char* name;
    double VerdictOptions::*value;
    double low, high;
};

constexpr double kMost = 1000.0;  ///< Largest effect, mGal and mGal/degC.

constexpr Key kKeys[] = {
    {"operating_degc", &VerdictOptions::operating_degc, -20.0, 80.0},
    {"warm_up_degc", &VerdictOptions::warm_up_degc, 0.1, 20.0},
    {"cycle_s", &VerdictOptions::cycle_s, 100.0, 3600.0},
    {"history_min", &VerdictOptions::history_min, 10.0, 120.0},
    {"static_mgal_per_degc", &VerdictOptions::static_mgal_per_degc, -kMost, kMost},
    {"rate_mgal_h_per_degc", &VerdictOptions::rate_mgal_h_per_degc, -kMost, kMost},
    {"slow_mgal_per_degc", &VerdictOptions::slow_mgal_per_degc, -kMost, kMost},
    {"slow_lag_min", &VerdictOptions::slow_lag_min, 1.0, 600.0},
    {"relax_min", &VerdictOptions::relax_min, 1.0, 600.0},
    {"warm_up_mgal", &VerdictOptions::warm_up_mgal, -kMost, kMost},
    {"warm_up_h", &VerdictOptions::warm_up_h, 0.1, 48.0},
    {"change_mgal", &VerdictOptions::change_mgal, 0.01, 1000.0},
    {"slope_degc_per_h", &VerdictOptions::slope_degc_per_h, 0.001, 100.0},
    {"sure", &VerdictOptions::sure, 0.0, 10.0},
    {"sure_stay", &VerdictOptions::sure_stay, 0.0, 10.0},
    {"doubt_mgal_per_degc", &VerdictOptions::doubt_mgal_per_degc, 0.0, kMost},
    {"hold_s", &VerdictOptions::hold_s, 0.0, 3600.0},
    {"knock_gal", &VerdictOptions::knock_gal, 0.01, 1000.0},
    {"quiet_s", &VerdictOptions::quiet_s, 0.0, 3600.0},
    {"shake_gal", &VerdictOptions::shake_gal, 0.01, 1000.0},
    {"shake_factor", &VerdictOptions::shake_factor, 1.0, 1000.0},
    {"shake_s", &VerdictOptions::shake_s, 0.0, 600.0},
    {"handled_s", &VerdictOptions::handled_s, 0.0, 600.0},
    {"watch_s", &VerdictOptions::watch_s, 0.0, 3600.0},
    {"lid_degc", &VerdictOptions::lid_degc, 0.0, 10.0},
    {"lid_degc_per_h", &VerdictOptions::lid_degc_per_h, 0.0, 100.0},
    {"tilt_deg", &VerdictOptions::tilt_deg, 0.001, 10.0},
    {"noise_factor", &VerdictOptions::noise_factor, 1.0, 1000.0},
    {"noise_floor_mgal", &VerdictOptions::noise_floor_mgal, 0.01, 1000.0},
    {"cycle_mgal", &VerdictOptions::cycle_mgal, 0.0, 1000.0},
    {"target_mgal", &VerdictOptions::target_mgal, 0.01, 1000.0},
    {"gap_s", &VerdictOptions::gap_s, 3.0, 600.0},
    {"stuck_s", &VerdictOptions::stuck_s, 10.0, 3600.0},
};

}  // namespace

VerdictOptions thresholds_for(const corrector::Calibration& unit) {
    VerdictOptions options;
    if (unit.thermal) {
        using corrector::ThermalTerm;
        const auto value = [&](ThermalTerm term) { return value_of(*unit.thermal, term); };
        options.static_mgal_per_degc = value(ThermalTerm::level);
        options.slow_mgal_per_degc = value(ThermalTerm::slow);
        options.rate_mgal_h_per_degc = value(ThermalTerm::fast);
        options.slow_lag_min = std::exp(value(ThermalTerm::slow_lag)) / 60.0;
    }
    if (unit.warm_up && unit.warm_up->after_power_on_h > 0.0 &&
        unit.warm_up->within_mgal < options.warm_up_mgal) {
        options.warm_up_h = unit.warm_up->after_power_on_h /
                            std::log(options.warm_up_mgal / unit.warm_up->within_mgal);
    }
    return options;
}

VerdictOptions read_verdict(text::TomlTable table, const VerdictOptions& defaults) {
    VerdictOptions options = defaults;
    for (const Key& key : kKeys)
        options.*key.value = table.number_or(key.name, options.*key.value, key.low, key.high);
    table.require_all_read();
    return options;
}

}  // namespace a351::daemon
