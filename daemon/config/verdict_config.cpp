#include "daemon/config/verdict_config.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace a351::daemon::config {
namespace {

/// A key and its plausible range; a value outside is a typing error.
struct Key {
    const char* name;
    double verdict::Options::*value;
    double low, high;
};

constexpr Key kKeys[] = {
    {"operating_degc", &verdict::Options::operating_degc, -20.0, 80.0},
    {"warm_up_degc", &verdict::Options::warm_up_degc, 0.1, 20.0},
    {"warm_up_h", &verdict::Options::warm_up_h, 0.1, 48.0},
    {"knock_gal", &verdict::Options::knock_gal, 0.01, 1000.0},
    {"shake_gal", &verdict::Options::shake_gal, 0.01, 1000.0},
    {"tilt_deg", &verdict::Options::tilt_deg, 0.001, 10.0},
    {"gap_s", &verdict::Options::gap_s, 3.0, 600.0},
    {"stuck_s", &verdict::Options::stuck_s, 10.0, 3600.0},
};

/// Longest pause of the host that must not look like a lack of data, real time.
constexpr std::chrono::milliseconds kPauseOfHost{500};

}  // namespace

verdict::Options thresholds_for(const unit::Calibration& unit) {
    verdict::Options options;
    if (unit.thermal) {
        using unit::ThermalTerm;
        const auto value = [&](ThermalTerm term) { return unit::value_of(*unit.thermal, term); };
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

Nanoseconds stale_after(const source::HostClock& clock) {
    return std::max<Nanoseconds>(kStaleAfter, clock.instrument_span(kPauseOfHost));
}

verdict::Options read_verdict(text::TomlTable table, const verdict::Options& defaults) {
    verdict::Options options = defaults;
    for (const Key& key : kKeys)
        options.*key.value = table.number_or(key.name, options.*key.value, key.low, key.high);
    table.require_all_read();
    return options;
}

}  // namespace a351::daemon::config
