#include "sim/scenario/survey_plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <numbers>
#include <system_error>

#include "protocol/core/input_error.hpp"
#include "protocol/core/units.hpp"
#include "protocol/text/csv.hpp"
#include "sim/noise/random.hpp"

namespace a351::sim::scenario {
namespace {

using text::shortest;

/// Largest delay of a stay beyond its jitter, s, to make room for the stay before and the drive.
constexpr double kMostMovedSeconds = 60.0;

UtcTime whole_milliseconds(UtcTime time) {
    return std::chrono::floor<std::chrono::milliseconds>(time);
}

[[noreturn]] void refuse(const Scenario& scenario, const ListedOccupation& listed,
                         const char* trouble) {
    throw InputError(fmt::format("scenario {}: occupation of {} ({}): {}", scenario.name,
                                 listed.site, listed.number, trouble));
}

struct Interval {
    UtcTime from, start, end;
};

/// Draws the times of each occupation, and from when on its site's gravity acts.
std::vector<Interval> draw_intervals(const Scenario& scenario, std::uint64_t seed) {
    noise::RandomStream stream(scenario.box_seed(seed), "schedule");
    const ScheduleParameters& p = scenario.schedule;
    std::vector<Interval> intervals;
    for (const ListedOccupation& listed : scenario.occupations) {
        const double shift_s = stream.uniform(-p.jitter_s, p.jitter_s);
        const double listed_s = listed.length_s.value_or(p.length_s);
        const double length_s = std::max(std::min(p.shortest_s, listed_s),
                                         listed_s + stream.uniform(-p.jitter_s, p.jitter_s));
        Interval interval{scenario.start(), {}, {}};
        interval.start = listed.centre + from_seconds(shift_s - 0.5 * length_s);
        const UtcTime drawn = interval.start;
        if (intervals.empty()) {
            interval.start = std::max(interval.start, scenario.start());
        } else {
            const UtcTime left = intervals.back().end;
            interval.start = std::max(interval.start, left + from_seconds(p.shortest_drive_s));
            interval.from = left + (interval.start - left) / 2;
        }
        if (seconds_between(drawn, interval.start) > p.jitter_s + kMostMovedSeconds) {
            refuse(
                scenario, listed,
                "the occupation before is not over in time; allowed: occupations further apart, or "
                "shorter");
        }
        interval.start = whole_milliseconds(interval.start);
        interval.end = std::min(whole_milliseconds(interval.start + from_seconds(length_s)),
                                whole_milliseconds(scenario.end()));
        if (seconds_between(interval.start, interval.end) <
            0.5 * std::min(p.shortest_s, listed_s)) {
            refuse(
                scenario, listed,
                "no room before the record ends; allowed: occupations further apart, or a larger "
                "schedule.lead_out_min");
        }
        intervals.push_back(interval);
    }
    return intervals;
}

/// Draws what differs from one set-up to the next.
class SetUpDraws {
public:
    SetUpDraws(const Scenario& scenario, std::uint64_t seed)
        : sigma_rad_(scenario.sensor.levelling_sigma_deg * kRadPerDeg),
          noise_(scenario.slow_noise),
          levelling_(scenario.box_seed(seed), "levelling"),
          placement_(seed, "placement"),
          box_placement_(scenario.box_seed(seed), "placement of the box"),
          gross_(seed, "gross") {
        if (scenario.box) box_share_ = scenario.box->placement_share;
    }

    void draw(PlannedSetUp& set_up) {
        set_up.about_y_rad = sigma_rad_ * levelling_.normal();
        set_up.about_x_rad = sigma_rad_ * levelling_.normal();
        set_up.placement_mgal =
            noise_.placement_mgal * (std::sqrt(1.0 - box_share_) * placement_.normal() +
                                     std::sqrt(box_share_) * box_placement_.normal());
        if (gross_.uniform() < noise_.placement_gross_share)
            set_up.placement_mgal *= noise_.placement_gross_factor;
    }

private:
    double sigma_rad_;
    double box_share_ = 0.0;  ///< Share of the placement's variance.
    const SlowNoiseParameters& noise_;
    noise::RandomStream levelling_, placement_, box_placement_, gross_;
};

}  // namespace

std::vector<PlannedSetUp> plan_survey(const Scenario& scenario, std::uint64_t seed) {
    SetUpDraws draws(scenario, seed);
    if (scenario.fixed_record) {
        PlannedSetUp set_up;
        set_up.site = scenario.sites.front();
        set_up.start = set_up.from = scenario.start();
        set_up.end = scenario.end();
        set_up.is_occupied = false;
        draws.draw(set_up);
        return {set_up};
    }
    const std::vector<Interval> intervals = draw_intervals(scenario, seed);
    std::vector<PlannedSetUp> plan;
    // The reading steps in one of the drives between two occupations.
    const double drives = static_cast<double>(intervals.size()) - 1.0;
    const double stepped = 1.0 + std::floor(noise::RandomStream(seed, "step").uniform(0.0, drives));
    for (std::size_t i = 0; i < intervals.size(); ++i) {
        const ListedOccupation& listed = scenario.occupations[i];
        const auto [from, start, end] = intervals[i];
        PlannedSetUp set_up;
        set_up.site = *text::find_site(scenario.sites, listed.site);
        set_up.number = listed.number;
        set_up.is_outlier = listed.is_outlier;
        if (static_cast<double>(i) >= stepped)
            set_up.step_mgal = scenario.slow_noise.transport_step_mgal;
        set_up.parts = listed.levelling.empty() ? scenario.schedule.set_ups
                                                : static_cast<int>(listed.levelling.size());
        for (int part = 1; part <= set_up.parts; ++part) {
            set_up.part = part;
            set_up.start = whole_milliseconds(start + (end - start) * (part - 1) / set_up.parts);
            set_up.end = whole_milliseconds(start + (end - start) * part / set_up.parts);
            set_up.from = part == 1 ? from : set_up.start;
            draws.draw(set_up);
            if (!listed.levelling.empty()) {
                const Levelling& angles = listed.levelling[static_cast<std::size_t>(part - 1)];
                set_up.about_y_rad = angles.about_y_deg * kRadPerDeg;
                set_up.about_x_rad = angles.about_x_deg * kRadPerDeg;
            }
            const std::string& faces = scenario.schedule.faces;
            const auto number = std::min(static_cast<std::size_t>(part), faces.size());
            set_up.face = faces[number - 1] == '-' ? -1.0 : 1.0;
            if (set_up.face < 0.0) set_up.about_x_rad += std::numbers::pi;
            plan.push_back(set_up);
        }
    }
    return plan;
}

plant::TemperatureErrorParameters drawn_unit(const Scenario& scenario, std::uint64_t seed) {
    plant::TemperatureErrorParameters unit = scenario.error;
    if (scenario.unit_scatter == 0.0) return unit;
    noise::RandomStream stream(seed, "unit");
    for (double* value : {&unit.crystal_static_mgal_per_degc, &unit.crystal_dynamic_mgal_per_degc,
                          &unit.crystal_tau_s, &unit.clock_mgal_per_degc, &unit.clock_tau_s,
                          &unit.warm_up_mgal, &unit.warm_up_tau_h}) {
        *value *= stream.uniform(1.0 - scenario.unit_scatter, 1.0 + scenario.unit_scatter);
    }
    return unit;
}

std::string sites_csv(const Scenario& scenario) {
    std::string csv = "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n";
    for (const text::Site& site : scenario.sites) {
        csv += fmt::format("{},{},{},{},{}\n", site.name, shortest(site.longitude.value()),
                           shortest(site.latitude.value()), shortest(site.altitude.value()),
                           shortest(site.gravity->value()));
    }
    return csv;
}

std::string schedule_csv(const std::vector<PlannedSetUp>& plan) {
    std::string csv = "site,occupation,start_utc,end_utc,used,note\n";
    for (const PlannedSetUp& set_up : plan) {
        if (!set_up.is_occupied) continue;
        csv += fmt::format("{},{},{},{},{}\n", set_up.site.name, set_up.number,
                           to_rfc3339(set_up.start, 3), to_rfc3339(set_up.end, 3),
                           set_up.is_outlier ? "0,left out by the publication" : "1,");
    }
    return csv;
}

void write_text_file(const std::filesystem::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary | std::ios::trunc);
    out << text;
    out.close();
    if (!out) throw std::system_error(errno, std::generic_category(), file.string());
}

}  // namespace a351::sim::scenario
