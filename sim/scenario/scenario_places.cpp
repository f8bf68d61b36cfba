#include "sim/scenario/scenario_places.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "protocol/text/csv.hpp"

namespace a351::sim::scenario {
namespace {

constexpr double kColdestDegC = -40.0, kWarmestDegC = 80.0;

/// Shortest set-up, s: the least that the keys length_s and shortest_s allow for an occupation.
constexpr double kShortestSetUpSeconds = 60.0;

text::Site read_site(text::TomlTable& table) {
    const text::Site site{
        .name = required_name(table),
        .longitude = Degrees(table.required_number("longitude_deg", -180.0, 360.0)),
        .latitude = Degrees(table.required_number("latitude_deg", -90.0, 90.0)),
        .altitude = Metres(
            table.required_number("altitude_m", text::kLeastAltitude_m, text::kGreatestAltitude_m)),
        .gravity = MilliGal(table.required_number("gravity_mgal", 970000.0, 990000.0))};
    table.require_all_read();
    return site;
}

/// Refuses air that is not colder than the set point: the oven can only heat.
void require_below_set_point(const text::TomlTable& table, std::string_view key, double degc,
                             const Scenario& scenario) {
    if (degc < scenario.oven.set_point_degc) return;
    table.refuse(key, "the oven only heats",
                 fmt::format("colder than oven.set_point_degc = {}",
                             text::shortest(scenario.oven.set_point_degc)));
}

std::string read_site_name(text::TomlTable& table, const Scenario& scenario) {
    std::string name = table.string_or("site", "");
    if (text::find_site(scenario.sites, name) == nullptr)
        table.refuse("site", "no such site", "the name of a [[site]]");
    return name;
}

int read_number(text::TomlTable& table) {
    return static_cast<int>(table.integer_or("number", 1, 1, std::numeric_limits<int>::max()));
}

std::vector<Levelling> read_levelling(text::TomlTable& table) {
    const std::vector<double> about_y_deg = table.numbers("about_y_deg", -180.0, 180.0);
    const std::vector<double> about_x_deg = table.numbers("about_x_deg", -180.0, 180.0);
    if (about_y_deg.size() != about_x_deg.size()) {
        table.refuse(table.has("about_x_deg") ? "about_x_deg" : "about_y_deg", "not a pair",
                     "about_y_deg and about_x_deg, one angle per set-up each");
    }
    std::vector<Levelling> levelling;
    for (std::size_t i = 0; i < about_y_deg.size(); ++i) {
        levelling.push_back({about_y_deg[i], about_x_deg[i]});
    }
    return levelling;
}

ListedOccupation read_occupation(text::TomlTable& table, const Scenario& scenario) {
    ListedOccupation occupation;
    occupation.site = read_site_name(table, scenario);
    occupation.number = read_number(table);
    occupation.centre = required_instant(table, "centre_utc");
    occupation.length_s = table.number("length_s", 60.0, 1e6);
    occupation.ambient_degc = table.number("ambient_degc", kColdestDegC, kWarmestDegC);
    if (occupation.ambient_degc)
        require_below_set_point(table, "ambient_degc", *occupation.ambient_degc, scenario);
    occupation.is_outlier = table.boolean_or("outlier", false);
    occupation.levelling = read_levelling(table);
    table.require_all_read();
    for (const ListedOccupation& other : scenario.occupations) {
        if (other.site == occupation.site && other.number == occupation.number)
            table.refuse("number", "given twice for this site", "each number once");
    }
    return occupation;
}

void read_sites(text::TomlTable& document, Scenario& scenario) {
    if (document.has("site")) scenario.sites.clear();
    for (text::TomlTable& table : document.tables("site")) {
        const text::Site site = read_site(table);
        if (text::find_site(scenario.sites, site.name) != nullptr)
            table.refuse("name", "given twice", "each site once");
        scenario.sites.push_back(site);
    }
    if (scenario.fixed_record && scenario.sites.size() != 1) {
        document.refuse("site", "not exactly one", "one [[site]] for a record without occupations");
    }
}

void read_occupations(text::TomlTable& document, Scenario& scenario) {
    if (document.has("occupation")) {
        if (scenario.fixed_record) {
            document.refuse("occupation", "given together with schedule.start_utc",
                            "only one of the two");
        }
        scenario.occupations.clear();
        scenario.ambient.clear();
        scenario.open_lids.clear();
    }
    for (text::TomlTable& table : document.tables("occupation")) {
        const ListedOccupation occupation = read_occupation(table, scenario);
        if (!scenario.occupations.empty() &&
            occupation.centre <= scenario.occupations.back().centre) {
            table.refuse("centre_utc", "not after the one before", "rising instants");
        }
        scenario.occupations.push_back(occupation);
    }
    for (const ListedOccupation& one : scenario.occupations) {
        if (text::find_site(scenario.sites, one.site) == nullptr) {
            document.refuse("site",
                            fmt::format("lacks {}, which the base's occupations use", one.site),
                            "every site in use, or a new [[occupation]] list");
        }
    }
    if (!scenario.fixed_record && scenario.occupations.empty()) {
        document.refuse("occupation", "missing",
                        "at least one [[occupation]], or schedule.start_utc");
    }
}

void read_ambient(text::TomlTable& document, Scenario& scenario) {
    if (document.has("ambient")) scenario.ambient.clear();
    for (text::TomlTable& table : document.tables("ambient")) {
        ListedAmbient knot;
        knot.hours = table.number("at_h", 0.0, 10'000.0);
        if (table.has("at_utc") == knot.hours.has_value())
            table.refuse("at_h", "not one instant", "either at_h or at_utc");
        if (!knot.hours) knot.utc = required_instant(table, "at_utc");
        knot.degc = table.required_number("degc", kColdestDegC, kWarmestDegC);
        require_below_set_point(table, "degc", knot.degc, scenario);
        table.require_all_read();
        scenario.ambient.push_back(knot);
        const std::vector<AmbientKnot> knots = scenario.ambient_knots();
        if (knots.size() > 1 && knots.back().time <= knots[knots.size() - 2].time) {
            table.refuse(knot.hours ? "at_h" : "at_utc", "not after the one before",
                         "rising instants");
        }
    }
    if (!scenario.ambient.empty()) return;
    const bool is_course_known =
        !scenario.fixed_record &&
        std::ranges::all_of(scenario.occupations, [](const ListedOccupation& one) {
            return one.ambient_degc.has_value();
        });
    if (!is_course_known) {
        document.refuse("ambient", "missing",
                        "at least one [[ambient]], or ambient_degc in every [[occupation]]");
    }
}

void read_open_lids(text::TomlTable& document, Scenario& scenario) {
    if (document.has("lid_open")) scenario.open_lids.clear();
    for (text::TomlTable& table : document.tables("lid_open")) {
        ListedOpenLid lid;
        if (table.has("site")) {
            lid.site = read_site_name(table, scenario);
            lid.number = read_number(table);
            if (std::ranges::none_of(scenario.occupations, [&](const ListedOccupation& one) {
                    return one.site == lid.site && one.number == lid.number;
                })) {
                table.refuse("site", "no such stay", "site and number of an [[occupation]]");
            }
        } else {
            lid.from = required_instant(table, "from_utc");
            lid.to = required_instant(table, "to_utc");
            if (lid.to <= lid.from) table.refuse("to_utc", "not after from_utc", "a later instant");
        }
        lid.outside_degc = table.required_number("outside_degc", kColdestDegC, kWarmestDegC);
        require_below_set_point(table, "outside_degc", lid.outside_degc, scenario);
        table.require_all_read();
        scenario.open_lids.push_back(lid);
    }
}

/// Refuses a set point that is not above the warmest air, which may come from a base or from the
/// schedule.
void require_warm_oven(text::TomlTable& document, const Scenario& scenario) {
    double warmest_degc = kColdestDegC;
    for (const AmbientKnot& knot : scenario.ambient_knots())
        warmest_degc = std::max(warmest_degc, knot.degc);
    for (const ListedOpenLid& lid : scenario.open_lids)
        warmest_degc = std::max(warmest_degc, lid.outside_degc);
    if (warmest_degc < scenario.oven.set_point_degc) return;
    document.table("oven").refuse("set_point_degc", "the oven only heats",
                                  fmt::format("above the warmest air around the oven, {} degC",
                                              text::shortest(warmest_degc)));
}

/// Returns the shortest length that draw_intervals() can draw.
double shortest_length_s(const ListedOccupation& one, const ScheduleParameters& p) {
    const double listed_s = one.length_s.value_or(p.length_s);
    return std::max(std::min(p.shortest_s, listed_s), listed_s - p.jitter_s);
}

void require_room_for_set_ups(text::TomlTable& document, const Scenario& scenario) {
    const ScheduleParameters& p = scenario.schedule;
    for (std::size_t i = 0; i < scenario.occupations.size(); ++i) {
        const ListedOccupation& one = scenario.occupations[i];
        const bool is_listed = !one.levelling.empty();
        const auto parts = is_listed ? one.levelling.size() : static_cast<std::size_t>(p.set_ups);
        if (shortest_length_s(one, p) >= kShortestSetUpSeconds * static_cast<double>(parts))
            continue;
        const std::string trouble =
            fmt::format("leaves less than 60 s for a set-up of {} ({})", one.site, one.number);
        if (is_listed && document.has("occupation")) {
            document.tables("occupation")[i].refuse("about_y_deg", trouble,
                                                    "fewer angles, or a longer occupation");
        }
        document.table("schedule")
            .refuse(is_listed ? "jitter_s" : "setups", trouble,
                    "fewer set-ups, longer occupations, or less jitter");
    }
}

/// Checks that several keys together fit.
void require_fit(text::TomlTable& document, const Scenario& scenario) {
    if (scenario.fixed_record) return;
    const ScheduleParameters& p = scenario.schedule;
    const auto half_s = [&](const ListedOccupation& one) {
        return 0.5 * one.length_s.value_or(p.length_s);
    };
    const text::TomlTable schedule = document.table("schedule");
    if (3600.0 * p.lead_in_h < half_s(scenario.occupations.front()))
        schedule.refuse("lead_in_h", "shorter than half the first occupation", "a longer one");
    if (60.0 * p.lead_out_min < half_s(scenario.occupations.back()))
        schedule.refuse("lead_out_min", "shorter than half the last occupation", "a longer one");
    require_room_for_set_ups(document, scenario);
}

}  // namespace

std::string required_name(text::TomlTable& table) {
    std::string name = table.string_or("name", "");
    if (name.empty()) table.refuse("name", "missing", "a name");
    const bool has_forbidden = std::ranges::any_of(name, [](char c) {
        const auto code = static_cast<unsigned char>(c);
        return c == '"' || c == ',' || c == '\\' || code < 0x20 || code == 0x7F;
    });
    if (has_forbidden) {
        table.refuse("name", "cannot be written into a table",
                     "a name without quotes, commas, backslashes and control characters");
    }
    return name;
}

UtcTime required_instant(text::TomlTable& table, std::string_view key) {
    const auto instant = parse_rfc3339(table.string_or(key, ""));
    if (!instant) table.refuse(key, "not an instant", "RFC 3339");
    return *instant;
}

void read_places(text::TomlTable& document, Scenario& scenario) {
    read_sites(document, scenario);
    read_occupations(document, scenario);
    read_ambient(document, scenario);
    read_open_lids(document, scenario);
    require_warm_oven(document, scenario);
    require_fit(document, scenario);
}

}  // namespace a351::sim::scenario
