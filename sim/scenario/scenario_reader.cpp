#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "protocol/core/input_error.hpp"
#include "protocol/text/aligned_text.hpp"
#include "protocol/text/csv.hpp"
#include "protocol/text/strict_toml.hpp"
#include "protocol/text/text_file.hpp"
#include "sim/scenario/embedded_scenarios.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/scenario/scenario_places.hpp"

namespace a351::sim::scenario {
namespace {

/// One table of the file.  Without a base every key is required, so that no value of a scenario is
/// hidden in the code.
class Section {
public:
    Section(text::TomlTable& document, std::string_view name, bool has_base)
        : table_(document.table(name)), has_base_(has_base) {}

    void number(std::string_view key, double& value, double low, double high) {
        require(key);
        value = table_.number_or(key, value, low, high);
    }

    /// Reads two ascending numbers.
    void range(std::string_view key, Range& value, double low, double high) {
        require(key);
        const std::vector<double> ends = table_.numbers(key, low, high);
        if (!table_.has(key)) return;
        if (ends.size() != 2 || ends[0] > ends[1])
            table_.refuse(key, "not a range", "two ascending numbers");
        value = {ends[0], ends[1]};
    }

    void integer(std::string_view key, int& value, int low, int high) {
        require(key);
        value = static_cast<int>(table_.integer_or(key, value, low, high));
    }

    void faces(std::string_view key, std::string& value) {
        require(key);
        value = table_.string_or(key, value);
        if (value.empty() || value.find_first_not_of("+-") != std::string::npos)
            table_.refuse(key, "not a list of faces", "signs + and -, for example +--+");
    }

    void boolean(std::string_view key, bool& value) {
        require(key);
        value = table_.boolean_or(key, value);
    }

    [[nodiscard]] std::string word(std::string_view key, std::string fallback,
                                   const std::vector<std::string>& allowed) {
        require(key);
        return table_.choice_or(key, std::move(fallback), allowed);
    }

    [[noreturn]] void refuse(std::string_view key, std::string_view trouble,
                             std::string_view allowed) const {
        table_.refuse(key, trouble, allowed);
    }

    void done() const { table_.require_all_read(); }

private:
    void require(std::string_view key) const {
        if (!has_base_ && !table_.has(key)) table_.refuse(key, "missing", "a value, or a base");
    }

    text::TomlTable table_;
    bool has_base_;
};

void read_schedule(Section& s, ScheduleParameters& p) {
    s.number("lead_in_h", p.lead_in_h, 0.0, 1000.0);
    s.number("lead_out_min", p.lead_out_min, 0.0, 1e5);
    s.number("length_s", p.length_s, 60.0, 1e6);
    s.number("jitter_s", p.jitter_s, 0.0, 1e5);
    s.number("shortest_s", p.shortest_s, 60.0, 1e6);
    s.number("shortest_drive_s", p.shortest_drive_s, 1.0, 1e5);
    s.integer("setups", p.set_ups, 1, 10);
    s.faces("faces", p.faces);
    s.number("ambient_before_degc", p.ambient_before_degc, -40.0, 80.0);
    s.number("ambient_after_degc", p.ambient_after_degc, -40.0, 80.0);
}

/// Reads a fixed record; keys that `base` has may be missing.
FixedRecord read_fixed_record(text::TomlTable table, const std::optional<FixedRecord>& base) {
    FixedRecord record = base.value_or(FixedRecord{});
    if (!base || table.has("start_utc")) record.start = required_instant(table, "start_utc");
    if (!base || table.has("duration_h"))
        record.duration_h = table.required_number("duration_h", 0.01, 10'000.0);
    table.require_all_read();
    return record;
}

void read_cool_box(Section& s, CoolBoxParameters& p) {
    s.number("walk_degc_per_sqrt_h", p.walk_degc_per_sqrt_h, 0.0, 10.0);
    s.number("open_tau_s", p.open_tau_s, 1.0, 1e5);
    s.number("closed_tau_s", p.closed_tau_s, 1.0, 1e5);
}

/// Refuses a capacity so small that in one step of the plant the node would lose more heat than
/// brings it to its neighbours' temperature: explicit Euler would be unstable.
void require_stable(const Section& s, std::string_view key, double capacity_j_per_k,
                    double conductance_w_per_k) {
    const double least_j_per_k = conductance_w_per_k * plant::ThermalPlant::kStepSeconds;
    if (capacity_j_per_k >= least_j_per_k) return;
    s.refuse(key, "too small for its thermal resistances with the plant's step of 1 s",
             text::shortest(least_j_per_k) + " or more, or larger resistances");
}

void read_oven(Section& s, plant::OvenParameters& p) {
    s.number("heater_capacity_j_per_k", p.heater_capacity_j_per_k, 1.0, 1e6);
    s.number("body_capacity_j_per_k", p.body_capacity_j_per_k, 1.0, 1e6);
    s.number("heater_body_k_per_w", p.heater_body_k_per_w, 0.01, 1e4);
    s.number("heater_ambient_k_per_w", p.heater_ambient_k_per_w, 0.01, 1e4);
    s.number("body_ambient_k_per_w", p.body_ambient_k_per_w, 0.01, 1e4);
    s.number("self_heating_w", p.self_heating_w, 0.0, 10.0);
    s.number("heater_power_w", p.heater_power_w, 0.1, 1000.0);
    s.number("thermocouple_tau_s", p.thermocouple_tau_s, 1.0, 1e4);
    s.number("dead_time_s", p.dead_time_s, 1.0, 1e4);
    s.number("set_point_degc", p.set_point_degc, 0.0, 80.0);
    s.number("resolution_degc", p.resolution_degc, 0.001, 10.0);
    s.number("proportional_per_degc", p.proportional_per_degc, 0.0, 1000.0);
    s.number("integral_per_degc_s", p.integral_per_degc_s, 0.0, 1000.0);
    s.number("run_in_h", p.run_in_h, 0.0, 100.0);
    const std::string now = p.controller == plant::ControllerKind::on_off ? "onoff" : "pi";
    const bool is_on_off = s.word("controller", now, {"pi", "onoff"}) == "onoff";
    p.controller = is_on_off ? plant::ControllerKind::on_off : plant::ControllerKind::pi;
    const double body_w_per_k = 1.0 / p.heater_body_k_per_w;
    require_stable(s, "heater_capacity_j_per_k", p.heater_capacity_j_per_k,
                   body_w_per_k + 1.0 / p.heater_ambient_k_per_w);
    require_stable(s, "body_capacity_j_per_k", p.body_capacity_j_per_k,
                   body_w_per_k + 1.0 / p.body_ambient_k_per_w);
}

/// Reads [outer_oven]; if it is new, it must have all keys.
void read_outer_oven(Section& s, OuterOvenParameters& p) {
    read_oven(s, p.oven);
    s.number("reading_mgal_per_degc", p.reading_mgal_per_degc, -1e4, 1e4);
    s.number("reading_tau_s", p.reading_tau_s, 1.0, 1e6);
}

void read_error(Section& s, plant::TemperatureErrorParameters& p, double& unit_scatter) {
    s.number("reference_degc", p.reference_degc, 0.0, 80.0);
    s.number("crystal_static_mgal_per_degc", p.crystal_static_mgal_per_degc, -1e5, 1e5);
    s.number("crystal_quadratic_mgal_per_degc2", p.crystal_quadratic_mgal_per_degc2, -1e5, 1e5);
    s.number("crystal_dynamic_mgal_per_degc", p.crystal_dynamic_mgal_per_degc, -1e5, 1e5);
    s.number("crystal_tau_s", p.crystal_tau_s, 1.0, 1e6);
    s.number("clock_mgal_per_degc", p.clock_mgal_per_degc, -1e5, 1e5);
    s.number("clock_tau_s", p.clock_tau_s, 1.0, 1e6);
    s.number("warm_up_mgal", p.warm_up_mgal, -1e4, 1e4);
    s.number("warm_up_tau_h", p.warm_up_tau_h, 0.01, 1000.0);
    s.number("unit_scatter", unit_scatter, 0.0, 0.9);
}

void read_sensor(Section& s, SensorParameters& p, double run_in_h) {
    s.number("bias_mgal", p.bias_mgal, -1e5, 1e5);
    s.number("scale", p.scale, 0.9, 1.1);
    s.number("horizontal_bias_max_mgal", p.horizontal_bias_max_mgal, 0.0, 1e5);
    s.number("levelling_sigma_deg", p.levelling_sigma_deg, 0.0, 10.0);
    s.number("white_mgal", p.white_mgal, 0.0, 1e5);
    s.number("temperature_white_degc", p.temperature_white_degc, 0.0, 10.0);
    s.number("power_on_before_start_h", p.power_on_before_start_h, 0.0, 1e4);
    if (p.power_on_before_start_h < run_in_h) {
        s.refuse("power_on_before_start_h",
                 "shorter than oven.run_in_h, in which the powered sensor already heats the oven",
                 text::shortest(run_in_h) + " or more");
    }
    s.number("temperature_warm_up_degc", p.temperature_warm_up_degc, -10.0, 10.0);
    s.number("temperature_warm_up_tau_h", p.temperature_warm_up_tau_h, 0.01, 1000.0);
    s.number("scale_share", p.scale_share, 0.0, 1.0);
    s.number("turn_mgal", p.turn_mgal, 0.0, 1e4);
    s.number("turn_tau_s", p.turn_tau_s, 1.0, 1e5);
}

void read_clock(Section& s, ClockParameters& p) {
    s.number("error_ppm", p.error_ppm, -1e4, 1e4);
    s.number("wander_ppm_per_sqrt_h", p.wander_ppm_per_sqrt_h, 0.0, 100.0);
    s.number("temperature_ppm_per_degc", p.temperature_ppm_per_degc, -100.0, 100.0);
    s.number("declared_rate_hz", p.declared_rate_hz, 0.0, 51.0);
    s.integer("record_age_s", p.record_age_s, 1, 60);
}

void read_tide(Section& s, TideParameters& p) {
    s.number("gravimetric_factor", p.gravimetric_factor, 0.0, 2.0);
}

void read_slow_noise(Section& s, SlowNoiseParameters& p) {
    s.number("flicker_mgal", p.flicker_mgal, 0.0, 1000.0);
    s.number("flicker_shortest_s", p.flicker_shortest_s, 10.0, 1e6);
    s.number("flicker_longest_s", p.flicker_longest_s, 10.0, 1e7);
    if (p.flicker_shortest_s >= p.flicker_longest_s)
        s.refuse("flicker_longest_s", "not above flicker_shortest_s", "a longer period");
    s.number("resonant_mgal", p.resonant_mgal, 0.0, 1000.0);
    s.number("resonant_period_s", p.resonant_period_s, 10.0, 1e5);
    s.number("resonant_quality", p.resonant_quality, 0.5, 1000.0);
    s.number("white_20s_mgal", p.white_mgal, 0.0, 1000.0);
    s.number("temperature_20s_degc", p.temperature_degc, 0.0, 10.0);
    s.number("placement_mgal", p.placement_mgal, 0.0, 1000.0);
    s.number("placement_gross_share", p.placement_gross_share, 0.0, 1.0);
    s.number("placement_gross_factor", p.placement_gross_factor, 1.0, 1000.0);
    s.number("transport_step_mgal", p.transport_step_mgal, -1e5, 1e5);
    s.number("drift_linear_mgal_per_h", p.drift_linear_mgal_per_h, -1000.0, 1000.0);
    s.number("drift_quadratic_mgal_per_h2", p.drift_quadratic_mgal_per_h2, -1000.0, 1000.0);
    s.number("drift_walk_mgal_per_sqrt_h", p.drift_walk_mgal_per_sqrt_h, 0.0, 1000.0);
    s.number("drift_links_mgal_per_h_per_degc", p.drift_links_mgal_per_h_per_degc, -1e4, 1e4);
    s.number("drift_link_tau_s", p.drift_link_tau_s, 1.0, 1e6);
    s.number("ripple_mgal", p.ripple_mgal, 0.0, 1000.0);
    s.number("ripple_period_s", p.ripple_period_s, 10.0, 1e5);
    s.number("ripple_wander", p.ripple_wander, 0.0, 0.3);
    s.number("ripple_wander_s", p.ripple_wander_s, 1.0, 1e6);
}

void read_vibration(Section& s, VibrationParameters& p) {
    s.number("ground_mgal", p.ground_mgal, 0.0, 1e5);
    s.number("ground_low_hz", p.ground_low_hz, 0.1, 20.0);
    s.number("ground_high_hz", p.ground_high_hz, 0.1, 20.0);
    if (p.ground_low_hz >= p.ground_high_hz)
        s.refuse("ground_high_hz", "not above ground_low_hz", "a higher frequency");
    s.number("vehicles_per_h", p.vehicles_per_h, 0.0, 60.0);
    s.range("vehicle_s", p.vehicle_s, 0.1, 60.0);
    s.range("vehicle_hz", p.vehicle_hz, 0.1, 20.0);
    s.range("vehicle_gal", p.vehicle_gal, 0.0, 1000.0);
    s.number("handling_probability", p.handling_probability, 0.0, 1.0);
    s.range("handling_s", p.handling_s, 0.1, 60.0);
    s.range("handling_hz", p.handling_hz, 0.1, 20.0);
    s.range("handling_gal", p.handling_gal, 0.0, 1000.0);
    s.number("knock_probability", p.knock_probability, 0.0, 1.0);
    s.range("knock_s", p.knock_s, 0.1, 60.0);
    s.range("knock_hz", p.knock_hz, 0.1, 20.0);
    s.range("knock_gal", p.knock_gal, 0.0, 1000.0);
    s.range("knock_position", p.knock_position, 0.0, 1.0);
    s.range("axis_share", p.axis_share, 0.0, 1.0);
    s.number("spike_probability", p.spike_probability, 0.0, 1.0);
    s.range("spike_gal", p.spike_gal, 0.0, 1000.0);
}

void read_line(Section& s, LineParameters& p) {
    s.number("latency_timer_ms", p.latency_timer_ms, 0.0, 255.0);
    s.number("latency_timer_ppm", p.latency_timer_ppm, -1e4, 1e4);
    s.number("usb_poll_ms", p.usb_poll_ms, 0.0, 100.0);
    s.number("jitter_ms", p.jitter_ms, 0.0, 1000.0);
    s.number("stall_per_h", p.stall_per_h, 0.0, 3600.0);
    s.range("stall_s", p.stall_s, 0.0, 60.0);
    s.boolean("is_bytewise", p.is_bytewise);
    s.boolean("is_paced", p.is_paced);
}

void read_box(Section& s, BoxParameters& p) {
    s.integer("seed", p.seed, 0, std::numeric_limits<int>::max());
    s.number("placement_share", p.placement_share, 0.0, 1.0);
}

const EmbeddedScenario* find_embedded(std::string_view name) {
    const auto all = embedded_scenarios();
    const auto found = std::ranges::find(all, name, &EmbeddedScenario::name);
    return found == all.end() ? nullptr : &*found;
}

std::string name_list() {
    const auto names = scenario_names();
    return text::joined({names.begin(), names.end()});
}

}  // namespace

Scenario parse_scenario(std::string_view toml, const std::filesystem::path& origin) {
    text::TomlTable document = text::parse_toml(toml, origin);
    const std::string base = document.string_or("base", "");
    Scenario scenario;
    if (!base.empty()) {
        const EmbeddedScenario* found = find_embedded(base);
        if (found == nullptr) document.refuse("base", "no such scenario", name_list());
        scenario = parse_scenario(found->toml, base + ".toml");
    }
    scenario.name = required_name(document);
    const auto read = [&](std::string_view name, auto reader, auto&... values) {
        const bool may_lack = !base.empty() || name == "clock" || name == "line";
        Section section(document, name, may_lack);
        reader(section, values...);
        section.done();
    };
    const bool has_own_record = document.table("schedule").has("start_utc");
    if (has_own_record || (scenario.fixed_record && !document.has("occupation"))) {
        scenario.fixed_record =
            read_fixed_record(document.table("schedule"), scenario.fixed_record);
        scenario.occupations.clear();
        if (has_own_record) scenario.open_lids.clear();
    } else {
        scenario.fixed_record.reset();
        read("schedule", read_schedule, scenario.schedule);
    }
    read("cool_box", read_cool_box, scenario.cool_box);
    read("oven", read_oven, scenario.oven);
    Section outer(document, "outer_oven", scenario.outer_oven.has_value());
    if (document.has("outer_oven")) {
        if (!scenario.outer_oven) scenario.outer_oven.emplace();
        read_outer_oven(outer, *scenario.outer_oven);
        outer.done();
    }
    read("temperature_error", read_error, scenario.error, scenario.unit_scatter);
    read("sensor", read_sensor, scenario.sensor, scenario.oven.run_in_h);
    read("clock", read_clock, scenario.clock);
    read("tide", read_tide, scenario.tide);
    read("slow_noise", read_slow_noise, scenario.slow_noise);
    read("vibration", read_vibration, scenario.vibration);
    read("line", read_line, scenario.line);
    Section box(document, "box", scenario.box.has_value());
    if (document.has("box")) {
        if (!scenario.box) scenario.box.emplace();
        read_box(box, *scenario.box);
        box.done();
    }
    read_places(document, scenario);
    document.require_all_read();
    return scenario;
}

Scenario load_scenario(const std::string& name_or_file) {
    if (const EmbeddedScenario* found = find_embedded(name_or_file))
        return parse_scenario(found->toml, name_or_file + ".toml");
    if (!std::filesystem::is_regular_file(name_or_file)) {
        throw InputError(
            fmt::format("--scenario {}: neither a scenario nor a file; allowed: {}, or a file",
                        name_or_file, name_list()));
    }
    return parse_scenario(text::read_text_file(name_or_file), name_or_file);
}

std::vector<std::string_view> scenario_names() {
    std::vector<std::string_view> names;
    for (const EmbeddedScenario& scenario : embedded_scenarios()) names.push_back(scenario.name);
    return names;
}

}  // namespace a351::sim::scenario
