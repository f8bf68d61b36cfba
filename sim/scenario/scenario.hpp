#pragma once
/// @file
/// Everything a simulated day is made of, read from TOML: config/scenarios/*.toml, whose comments
/// say which values are published, fitted or assumed.  Named scenarios are compiled in.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/text/sites.hpp"
#include "sim/plant/temperature_error.hpp"
#include "sim/plant/thermal_plant.hpp"

namespace a351::sim {

/// One stay at a site as listed, before its start and length are drawn.
struct ListedOccupation {
    std::string site;
    int number = 1;  ///< Counts the stays at this site.
    UtcTime centre;
    double ambient_degc = 0.0;  ///< Air inside the cool box at that time.
    bool is_outlier = false;    ///< Left out by the publication.
};

struct ScheduleParameters {
    double lead_in_h = 0.0;     ///< Record before the first occupation's centre.
    double lead_out_min = 0.0;  ///< ... and after the last one's.
    double length_s = 0.0;
    double jitter_s = 0.0;  ///< Centre and length are uniform within +- this.
    double shortest_s = 0.0;
    double ambient_before_degc = 0.0;  ///< At the start of the record.
    double ambient_after_degc = 0.0;   ///< At its end.
};

struct SensorParameters {
    double bias_mgal = 0.0;                 ///< Along the vertical.
    double horizontal_bias_max_mgal = 0.0;  ///< x and y, uniform within +- this, fixed for a unit.
    double levelling_sigma_deg = 0.0;       ///< Two angles, drawn anew at each set-up.
    double white_mgal = 0.0;                ///< Rms per axis and sample.
    double temperature_white_degc = 0.0;    ///< Rms per sample.
    double power_on_before_start_h = 0.0;
    double temperature_warm_up_degc = 0.0;  ///< Of the reported temperature, decaying ...
    double temperature_warm_up_tau_h = 0.0;
};

struct SlowNoiseParameters {
    double flicker_mgal = 0.0;  ///< Rms over the day.
    double flicker_shortest_s = 0.0;
    double flicker_longest_s = 0.0;
    double resonant_mgal = 0.0;
    double resonant_period_s = 0.0;
    double resonant_quality = 0.0;
    double white_mgal = 0.0;      ///< Rms of 20 s means.
    double placement_mgal = 0.0;  ///< One draw per set-up.
    double drift_linear_mgal_per_h = 0.0;
    double drift_quadratic_mgal_per_h2 = 0.0;
    double drift_walk_mgal_per_sqrt_h = 0.0;
    double ripple_mgal = 0.0;  ///< Amplitude on the vertical.
    double ripple_period_s = 0.0;
    double ripple_wander = 0.0;  ///< Rms of the period, relative.
};

struct Range {
    double low = 0.0, high = 0.0;
};

struct VibrationParameters {
    double ground_mgal = 0.0;  ///< Rms per axis between the two corners.
    double ground_low_hz = 0.0, ground_high_hz = 0.0;
    double vehicles_per_h = 0.0;
    Range vehicle_s, vehicle_hz, vehicle_gal;
    double handling_probability = 0.0;  ///< At each end of an occupation.
    Range handling_s, handling_hz, handling_gal;
    double knock_probability = 0.0;  ///< Per occupation.
    Range knock_s, knock_gal;        ///< Frequency: as handling.
    double spike_probability = 0.0;  ///< Per sample.
    Range spike_gal;
};

struct Scenario {
    std::string name;
    std::vector<text::Site> sites;
    std::vector<ListedOccupation> occupations;  ///< In time order.
    ScheduleParameters schedule;
    OvenParameters oven;
    TemperatureErrorParameters error;
    SensorParameters sensor;
    SlowNoiseParameters slow_noise;
    VibrationParameters vibration;

    /// The record's limits; the sample grid starts at start().
    [[nodiscard]] UtcTime start() const;
    [[nodiscard]] UtcTime end() const;

    /// Air around the oven: linear between the occupations' values, constant outside.
    [[nodiscard]] DegC ambient(UtcTime time) const;
};

/// A compiled-in scenario by name, or a TOML file.
/// @throws InputError  neither; or the file is not a scenario.  A key that is missing without
///                     `base` is refused, as is an unknown one.
[[nodiscard]] Scenario load_scenario(const std::string& name_or_file);

/// As load_scenario, from text.  `origin` stands for the file name in messages.
[[nodiscard]] Scenario parse_scenario(std::string toml, const std::filesystem::path& origin);

[[nodiscard]] std::vector<std::string_view> scenario_names();

}  // namespace a351::sim
