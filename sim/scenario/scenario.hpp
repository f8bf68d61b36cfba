#pragma once
/// @file
/// All parameters of a simulated day, read from TOML (config/scenarios/*.toml).  The comments there
/// say which values are published, fitted or assumed.  Named scenarios are compiled in.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/core/units.hpp"
#include "protocol/core/utc_time.hpp"
#include "protocol/text/sites.hpp"
#include "sim/plant/temperature_error.hpp"
#include "sim/plant/thermal_plant.hpp"

namespace a351::sim::scenario {

/// Angles between the box and the vertical.
struct Levelling {
    double about_y_deg = 0.0;  ///< First turn; positive: the x axis senses part of gravity.
    double about_x_deg = 0.0;  ///< Second turn; positive: the y axis senses part of it, negatively.
};

/// One stay at a site as listed, before its start and length are drawn.
struct ListedOccupation {
    std::string site;
    int number = 1;  ///< Counts the stays at this site.
    UtcTime centre;
    std::optional<double> length_s;      ///< Overrides the schedule's length.
    std::optional<double> ambient_degc;  ///< Air inside the cool box at that time.
    bool is_outlier = false;             ///< Left out by the publication.
    std::vector<Levelling> levelling;    ///< One per set-up; empty: drawn for the usual number.
};

/// A record at one point, without occupations.
struct FixedRecord {
    UtcTime start;
    double duration_h = 0.0;
};

struct ScheduleParameters {
    double lead_in_h = 0.0;     ///< From the start of the record to the first occupation's centre.
    double lead_out_min = 0.0;  ///< From the last occupation's centre to the end of the record.
    double length_s = 0.0;
    double jitter_s = 0.0;  ///< Centre and length vary uniformly within +- this.
    double shortest_s = 0.0;
    double shortest_drive_s = 0.0;  ///< From the end of one stay to the start of the next.
    int set_ups = 1;  ///< Per occupation, of equal length; the box is lifted in between.
    /// Faces of the set-ups of a stay, '+' or '-', one after the other; further ones have the last face.
    std::string faces;
    double ambient_before_degc = 0.0;  ///< Air inside the cool box at the start of the record.
    double ambient_after_degc = 0.0;   ///< Air inside the cool box at the end of the record.
};

/// Air inside the cool box at an instant, given as UTC or in hours after the start of the record.
struct ListedAmbient {
    std::optional<double> hours;
    UtcTime utc;  ///< Used without `hours`.
    double degc = 0.0;
};

struct AmbientKnot {
    UtcTime time;
    double degc = 0.0;
};

/// Time during which the lid is open: a stay, or from one instant to another.
struct ListedOpenLid {
    std::string site;  ///< Empty: `from` and `to` count.
    int number = 1;
    UtcTime from, to;
    double outside_degc = 0.0;
};

struct CoolBoxParameters {
    double walk_degc_per_sqrt_h = 0.0;  ///< Random walk of the air inside.
    double open_tau_s = 0.0;    ///< Time constant, lid open: the air inside follows the outside.
    double closed_tau_s = 0.0;  ///< Time constant, lid closed: it returns to its own course.
};

struct SensorParameters {
    double bias_mgal = 0.0;  ///< Along the vertical.
    double scale =
        1.0;  ///< Change of the reading divided by that of gravity; exact at 980665 mGal.
    double horizontal_bias_max_mgal = 0.0;  ///< x and y, drawn uniformly within +- this for a unit.
    double levelling_sigma_deg = 0.0;       ///< Two angles, drawn for each set-up.
    double white_mgal = 0.0;                ///< Rms per axis and sample.
    double temperature_white_degc = 0.0;    ///< Rms per sample.
    double power_on_before_start_h = 0.0;   ///< At least OvenParameters::run_in_h.
    /// Share of each error, but for bias, placement and white noise, that is one of the scale: it keeps
    /// its sign when the sensor is turned over.  Bias and scale flicker
    /// independently, with amplitudes as 1 - share to share.
    double scale_share = 0.0;
    double turn_mgal = 0.0;   ///< Standard deviation of the error at a turn, drawn for each.
    double turn_tau_s = 0.0;  ///< Time constant of its decay.
    double temperature_warm_up_degc = 0.0;  ///< Excess of the reported temperature; it decays.
    double temperature_warm_up_tau_h = 0.0;
};

/// Rate of the sensor's sample clock against true time; positive: fast.
struct ClockParameters {
    double error_ppm = 0.0;
    double wander_ppm_per_sqrt_h = 0.0;     ///< Random walk.
    double temperature_ppm_per_degc = 0.0;  ///< Per degC above the temperature error's reference.
    double declared_rate_hz = 0.0;          ///< Written by `survey` into its records; 0: none.
    int record_age_s = 60;                  ///< Longest time in a record that `survey` writes.
};

struct SlowNoiseParameters {
    double flicker_mgal = 0.0;  ///< Rms over the day.
    double flicker_shortest_s = 0.0;
    double flicker_longest_s = 0.0;
    double resonant_mgal = 0.0;
    double resonant_period_s = 0.0;
    double resonant_quality = 0.0;
    double white_mgal = 0.0;              ///< Rms of 20 s means.
    double temperature_degc = 0.0;        ///< White, rms of 20 s means of the reported temperature.
    double placement_mgal = 0.0;          ///< One draw per set-up.
    double placement_gross_share = 0.0;   ///< Share of set-ups with a larger placement.
    double placement_gross_factor = 0.0;  ///< How much larger.
    double transport_step_mgal = 0.0;     ///< From one drive on, which is drawn.
    double drift_linear_mgal_per_h = 0.0;
    double drift_quadratic_mgal_per_h2 = 0.0;
    double drift_walk_mgal_per_sqrt_h = 0.0;
    double drift_links_mgal_per_h_per_degc =
        0.0;                        ///< Drift rate by the temperature after the links.
    double drift_link_tau_s = 0.0;  ///< Time constant of each of the three links.
    double ripple_mgal = 0.0;       ///< Amplitude on the vertical.
    double ripple_period_s = 0.0;
    double ripple_wander = 0.0;    ///< Rms of the period, relative.
    double ripple_wander_s = 0.0;  ///< Time constant of the wander.
};

struct Range {
    double low = 0.0, high = 0.0;
};

struct TideParameters {
    double gravimetric_factor = 0.0;  ///< 1 for the rigid Earth.
};

struct VibrationParameters {
    double ground_mgal = 0.0;  ///< Rms per axis between the two corners.
    double ground_low_hz = 0.0, ground_high_hz = 0.0;
    double vehicles_per_h = 0.0;
    Range vehicle_s, vehicle_hz, vehicle_gal;
    double handling_probability = 0.0;  ///< At each end of a set-up.
    Range handling_s, handling_hz, handling_gal;
    double knock_probability = 0.0;  ///< Per occupation.
    Range knock_s, knock_hz, knock_gal;
    Range knock_position;            ///< Start as a share of the set-up.
    Range axis_share;                ///< Share of a burst's strength, drawn for each axis.
    double spike_probability = 0.0;  ///< Per sample.
    Range spike_gal;
};

/// Delays by the adapter and by the host's driver.  With zeros, bytes arrive at once.
struct LineParameters {
    double latency_timer_ms = 0.0;   ///< The adapter hands bytes over on this grid.
    double latency_timer_ppm = 0.0;  ///< Rate error of this grid by simulated time; positive: fast.
    double usb_poll_ms = 0.0;        ///< The host polls the adapter on this grid.
    double jitter_ms = 0.0;          ///< Further delay, uniform between 0 and this.
    double stall_per_h = 0.0;        ///< Mean number of stalls, at random instants.
    Range stall_s;                   ///< Length of a stall.
    bool is_bytewise = false;        ///< Every byte is handed over separately.
    bool is_paced = false;           ///< Bytes are delayed by their time on the wire (baud rate).
};

/// An oven around the oven, and what its temperature does to the reading:
///
///     err = slope (lag(Th, tau) - set point)
///
/// Th is the temperature of its wall, which its heater warms; lag is first order (plant::Lag).
struct OuterOvenParameters {
    plant::OvenParameters oven;
    double reading_mgal_per_degc = 0.0;
    double reading_tau_s = 0.0;
};

/// The box in which a sensor is with others, or the sled.  Sensors of one box have its seed and
/// different seeds of their own.
struct BoxParameters {
    int seed = 0;  ///< Seed of their common quantities: times, levelling, air, vibration, and
    double placement_share = 0.0;  ///< this share of the placement's variance.
};

struct Scenario {
    std::string name;
    std::vector<text::Site> sites;
    std::vector<ListedOccupation> occupations;  ///< In time order; empty for a fixed record.
    std::optional<FixedRecord> fixed_record;
    std::vector<ListedAmbient> ambient;  ///< Overrides the occupations' values.
    std::vector<ListedOpenLid> open_lids;
    ScheduleParameters schedule;
    CoolBoxParameters cool_box;
    plant::OvenParameters oven;
    std::optional<OuterOvenParameters> outer_oven;
    plant::TemperatureErrorParameters error;
    double unit_scatter = 0.0;  ///< `error` is drawn per unit within +- this share.
    SensorParameters sensor;
    ClockParameters clock;
    TideParameters tide;
    SlowNoiseParameters slow_noise;
    VibrationParameters vibration;
    LineParameters line;
    std::optional<BoxParameters> box;  ///< Absent: the sensor is alone.

    /// Returns the seed of the quantities that the sensors of a box have in common.
    /// @param seed  of the sensor, which a sensor alone has for all.
    [[nodiscard]] std::uint64_t box_seed(std::uint64_t seed) const {
        return box ? static_cast<std::uint64_t>(box->seed) : seed;
    }
    /// Return the limits of the record; the sample grid starts at start().
    [[nodiscard]] UtcTime start() const;
    [[nodiscard]] UtcTime end() const;

    /// Returns the course of the air inside the cool box in time order, for ambient_at().
    [[nodiscard]] std::vector<AmbientKnot> ambient_knots() const;
};

/// Interpolates linearly between the knots; constant before the first and after the last.
[[nodiscard]] DegC ambient_at(const std::vector<AmbientKnot>& knots, UtcTime time);

/// Returns a compiled-in scenario by name, or reads a TOML file.
/// @throws InputError  neither exists, or the file is not a scenario: it has an unknown key or,
///                     without `base`, lacks a key.  Only [clock], [line] and their keys may always
///                     be missing, and [outer_oven] as a whole; they default to no effect.
[[nodiscard]] Scenario load_scenario(const std::string& name_or_file);

/// Reads a scenario from text, as load_scenario() does.  Messages use `origin` as the file name.
[[nodiscard]] Scenario parse_scenario(std::string_view toml, const std::filesystem::path& origin);

[[nodiscard]] std::vector<std::string_view> scenario_names();

}  // namespace a351::sim::scenario
